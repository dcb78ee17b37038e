%
o<f> sub
o1 if [#1 LE 1]
o1 return [1]
o1 endif
#<n>=#1
o<f> call [#1-1]
o<f> endsub [#<_value>*#<n>]
o<f> call [5]
#1=0 #<_g>=[2**3 MOD 5 + ATAN[1]/[2] - SQRT[ABS[-4]]]
o2 while [#1 LT 3 AND [#1 NE 7]]
#1=[#1+1] G0 X#1 Y[-#<_g>/100]
o3 if [EXISTS[#<a>] OR #1 EQ 2]
o2 continue
o3 elseif [#1 GT 5]
o2 break
o3 else
(DEBUG, %.2f#1 #<_value> #<_x>)
o3 endif
o2 endwhile
o4 do
#2=[#2+1]
o4 while [#2 LT 2]
o5 repeat [3]
G91 G0 X1
o5 endrepeat
M98 P100 L2
%
O100
G91 G0 Z-1
M99

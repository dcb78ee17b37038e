%
(An S-shaped slot, 6 mm wide and 4 mm deep, in two passes)
(Stock: 60 x 40 x 12 mm, lower left corner of its top at X0 Y0 Z0)
(swarf simulate examples/slot.nc --stock box:0,0,-12,60,40,0 --tool 1=flat:d=6,l=18 --voxel 0.2)
G17 G21 G40 G49 G54 G80 G90 G94
T1 M6 (end mill, 6 mm)
G43 H1
S9000 M3 M8
G0 Z10
G0 X12 Y10
Z1
(down a ramp to Z-2, then along the S)
G1 Z0 F300
X24 Z-1
X12 Z-2
X40 F600
G3 X40 Y20 I0 J5
G1 X20
G2 X20 Y30 R5
G1 X48
(down again where the way ends, and back)
X36 Z-3 F300
X48 Z-4
X20 F600
G3 Y20 J-5
G1 X40
G2 Y10 J-5
G1 X12
G0 Z10
M5 M9
M30
%

%
(A bracket: faced, pocketed, cut out but for 2 mm, drilled at six places)
(Stock: 60 x 40 x 12 mm, lower left corner of its top at X0 Y0 Z0)
(swarf simulate examples/bracket.nc --stock box:0,0,-12,60,40,0)
(  --tool 1=flat:d=6,l=20 --tool 2=drill:d=4,l=40 --voxel 0.2)
G17 G21 G40 G49 G54 G80 G90 G91.1 G94

T1 M6 (end mill, 6 mm)
G43 H1
S9000 M3 M8
G0 Z15

(Face: 0.5 mm off, back and forth every 5 mm)
G0 X-5 Y0
G0 Z1
G1 Z-0.5 F400
X65 F900
G91 Y5
X-70
Y5
X70
Y5
X-70
Y5
X70
Y5
X-70
Y5
X70
Y5
X-70
Y5
X70
G90
G0 Z5

(Pocket: 30 x 16 mm with 5 mm corners about X30 Y20, to Z-6.5 in two levels)
(Helix to the level, a loop inside, a loop along the wall)
G0 X32 Y20
G0 Z0.5
G3 Z-3.5 I-2 P3 F300
G3 I-2
G1 X38 Y21 F600
X22
Y19
X38
Y21
X42 Y20
Y23
G3 X40 Y25 I-2
G1 X20
G3 X18 Y23 J-2
G1 Y17
G3 X20 Y15 I2
G1 X40
G3 X42 Y17 J2
G1 Y20
G1 X32
G3 Z-6.5 I-2 P3 F300
G3 I-2
G1 X38 Y21 F600
X22
Y19
X38
Y21
X42 Y20
Y23
G3 X40 Y25 I-2
G1 X20
G3 X18 Y23 J-2
G1 Y17
G3 X20 Y15 I2
G1 X40
G3 X42 Y17 J2
G1 Y20
X36
G0 Z5

(Outline: 54 x 34 mm with 6 mm corners; the tool's centre runs 3 mm outside)
(In and out on arcs, three levels, clockwise)
G0 X36 Y-6
G0 Z1
G1 Z-4 F400
G3 X30 Y0 I-6 F600
G1 X9
G2 X0 Y9 J9
G1 Y31
G2 X9 Y40 I9
G1 X51
G2 X60 Y31 J-9
G1 Y9
G2 X51 Y0 I-9
G1 X30
G3 X24 Y-6 R6
G0 X36
G1 Z-8 F400
G3 X30 Y0 I-6 F600
G1 X9
G2 X0 Y9 J9
G1 Y31
G2 X9 Y40 I9
G1 X51
G2 X60 Y31 J-9
G1 Y9
G2 X51 Y0 I-9
G1 X30
G3 X24 Y-6 R6
G0 X36
G1 Z-10 F400
G3 X30 Y0 I-6 F600
G1 X9
G2 X0 Y9 J9
G1 Y31
G2 X9 Y40 I9
G1 X51
G2 X60 Y31 J-9
G1 Y9
G2 X51 Y0 I-9
G1 X30
G3 X24 Y-6 R6
G0 Z15
M5 M9

T2 M6 (drill, 4 mm)
G43 H2
S3000 M3 M8
G0 X9 Y9
G0 Z10
(four holes through, in pecks of 3 mm; the point goes 1.2 mm out)
G99 G83 X9 Y9 Z-13.2 R1 Q3 F150
X51
Y31
G98 X9
(two blind holes with a dwell)
G99 G82 X9 Y20 Z-5 R1 P0.2
G98 X51
G80
G0 Z15
M5 M9
M30
%

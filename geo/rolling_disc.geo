// A disc on an incline; the disc has a mesh of its own.
//
//          __
//         /  \               regions  ground, disc
//        | O  |              curves   foot (bottom and sides of the ground), slope
//     ----\__/___
//    |           ---___
//    | ground          |
//    +-----------------+
DefineConstant[
  angle  = {20,   Min 0, Max 45, Name "Parameters/angle"},  // of the slope [degrees]
  radius = {0.5,  Min 1e-6, Name "Parameters/radius"},      // of the disc [m]
  length = {3,    Min 1e-6, Name "Parameters/length"},      // of the slope [m]
  depth  = {0.5,  Min 1e-6, Name "Parameters/depth"},       // of the ground, vertically [m]
  start  = {0.8,  Min 1e-6, Name "Parameters/start"},       // of the disc from the upper end of the slope [m]
  h      = {0.1,  Min 1e-6, Name "Parameters/h"}            // size of the cells [m]
];
c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
Point(1) = {0, 0, 0, h};
Point(2) = {length * c, -length * s, 0, h};
Point(3) = {length * c, -length * s - depth, 0, 2 * h};
Point(4) = {0, -depth, 0, 2 * h};
Line(1) = {1, 4};
Line(2) = {4, 3};
Line(3) = {3, 2};
Line(4) = {2, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

// The centre, and where the disc touches the slope.
x = start * c + radius * s;
y = -start * s + radius * c;
Point(10) = {x, y, 0, h};
Point(11) = {x - radius * s, y - radius * c, 0, h};
Point(12) = {x + radius * c, y - radius * s, 0, h};
Point(13) = {x + radius * s, y + radius * c, 0, h};
Point(14) = {x - radius * c, y + radius * s, 0, h};
Circle(11) = {11, 10, 12};
Circle(12) = {12, 10, 13};
Circle(13) = {13, 10, 14};
Circle(14) = {14, 10, 11};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Physical Surface("ground") = {1};
Physical Surface("disc") = {2};
Physical Curve("foot") = {1, 2, 3};
Physical Curve("slope") = {4};

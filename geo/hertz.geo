// Two bodies that touch along a line: the lower one is flat, the upper one round. Their meshes, of different sizes, have
// nothing to do with each other, and are fine where they touch.
//
//   14------top------13       regions  lower, upper
//   |     upper      |        curves   bottom, top, flanks (of the lower body), round (of the upper one)
//   11___        ___12
//   4----"""""--------3
//   |     lower      |
//   1-----bottom-----2
DefineConstant[
  radius = {50,   Min 1e-6, Name "Parameters/radius"},  // of the upper body [m]
  width  = {40,   Min 1e-6, Name "Parameters/width"},   // of both [m]
  height = {20,   Min 1e-6, Name "Parameters/height"},  // of both [m]
  near   = {1.5,  Min 1e-6, Name "Parameters/near"},    // half the width of the fine part [m]
  h      = {0.12, Min 1e-6, Name "Parameters/h"},       // size of the cells of the lower body there [m]
  ratio  = {0.8,  Min 1e-6, Name "Parameters/ratio"}    // that of the upper body over it [-]
];
far = width / 12;
w = width / 2;
rise = radius - Sqrt(radius^2 - w^2);
inner = radius - Sqrt(radius^2 - near^2);

Point(1) = {-w, -height, 0, far};
Point(2) = {w, -height, 0, far};
Point(3) = {w, 0, 0, far};
Point(4) = {-w, 0, 0, far};
Point(5) = {-near, 0, 0, h};
Point(6) = {near, 0, 0, h};
Point(7) = {0, -near, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 6};
Line(4) = {6, 5};
Line(5) = {5, 4};
Line(6) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Point{7} In Surface{1};

Point(10) = {0, radius, 0, far};
Point(11) = {-w, rise, 0, far};
Point(12) = {w, rise, 0, far};
Point(13) = {w, rise + height, 0, far};
Point(14) = {-w, rise + height, 0, far};
Point(15) = {-near, inner, 0, ratio * h};
Point(16) = {near, inner, 0, ratio * h};
Point(17) = {0, near, 0, ratio * h};
Circle(11) = {11, 10, 15};
Circle(12) = {15, 10, 16};
Circle(13) = {16, 10, 12};
Line(14) = {12, 13};
Line(15) = {13, 14};
Line(16) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14, 15, 16};
Plane Surface(2) = {2};
Point{17} In Surface{2};

Physical Surface("lower") = {1};
Physical Surface("upper") = {2};
Physical Curve("bottom") = {1};
Physical Curve("flanks") = {2, 6};
Physical Curve("top") = {15};
Physical Curve("round") = {11, 12, 13};

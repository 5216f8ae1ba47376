// A slender bar for axial vibration: fixed at the left, on rollers below, free at the right.
//
//   +--------------------+
// f |        bar         | free      regions  bar
//   +--------------------+           curves   fixed, free, lower, upper
DefineConstant[
  length = {1,    Min 1e-6, Name "Parameters/length"},  // [m]
  depth  = {0.05, Min 1e-6, Name "Parameters/depth"},   // [m]
  h      = {0.05, Min 1e-6, Name "Parameters/h"},       // size of the cells [m]
  quads  = {0, Choices{0, 1}, Name "Parameters/quads"}
];
Point(1) = {0, 0, 0, h};
Point(2) = {length, 0, 0, h};
Point(3) = {length, depth, 0, h};
Point(4) = {0, depth, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
nx = Ceil(length / h - 1e-9);
ny = Ceil(depth / h - 1e-9);
Transfinite Curve{1, 3} = nx + 1;
Transfinite Curve{2, 4} = ny + 1;
If (quads)
  Transfinite Surface{1};
  Recombine Surface{1};
EndIf
Physical Surface("bar") = {1};
Physical Curve("lower") = {1};
Physical Curve("free") = {2};
Physical Curve("upper") = {3};
Physical Curve("fixed") = {4};

// A cantilever, clamped at the left and loaded at the right end.
//
//   +------------------------+
// c |          beam          | tip      regions  beam
//   +------------------------+          curves   clamp, tip, lower, upper
//                                       points   tip_point (middle of the tip)
DefineConstant[
  length = {20, Min 1e-6, Name "Parameters/length"},  // [m]
  depth  = {1,  Min 1e-6, Name "Parameters/depth"},   // [m]
  h      = {0.5, Min 1e-6, Name "Parameters/h"},      // size of the cells [m]
  quads  = {0, Choices{0, 1}, Name "Parameters/quads"}
];
Point(1) = {0, -depth / 2, 0, h};
Point(2) = {length, -depth / 2, 0, h};
Point(3) = {length, 0, 0, h};
Point(4) = {length, depth / 2, 0, h};
Point(5) = {0, depth / 2, 0, h};
Point(6) = {0, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
nx = Ceil(length / h - 1e-9);
ny = Ceil(depth / (2 * h) - 1e-9);
Transfinite Curve{1, 4} = nx + 1;
Transfinite Curve{2, 3, 5, 6} = ny + 1;
If (quads)
  Transfinite Surface{1} = {1, 2, 4, 5};
  Recombine Surface{1};
EndIf
Physical Surface("beam") = {1};
Physical Curve("lower") = {1};
Physical Curve("tip") = {2, 3};
Physical Curve("upper") = {4};
Physical Curve("clamp") = {5, 6};
Physical Point("tip_point") = {3};

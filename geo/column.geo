// A column of soil under its own weight: a rectangle on rollers.
//
//   surface
//   +-----+
//   |     |
// l | soil| r      regions  soil
//   |     |        curves   bottom, left, right, surface
//   +-----+
//   bottom
DefineConstant[
  width  = {1,    Min 1e-6, Name "Parameters/width"},   // [m]
  height = {10,   Min 1e-6, Name "Parameters/height"},  // [m]
  h      = {1,    Min 1e-6, Name "Parameters/h"},       // size of the cells [m]
  quads  = {0, Choices{0, 1}, Name "Parameters/quads"}  // 1: regular quadrilaterals
];
Point(1) = {0, 0, 0, h};
Point(2) = {width, 0, 0, h};
Point(3) = {width, height, 0, h};
Point(4) = {0, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
// The same divisions in both variants, so that h counts the cells over the height exactly.
nx = Ceil(width / h - 1e-9);
ny = Ceil(height / h - 1e-9);
Transfinite Curve{1, 3} = nx + 1;
Transfinite Curve{2, 4} = ny + 1;
If (quads)
  Transfinite Surface{1};
  Recombine Surface{1};
EndIf
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("surface") = {3};
Physical Curve("left") = {4};

// A layer of soil that drains at its top: a strip between smooth walls.
//
//     top
//   +-----+
//   |     |
// l | soil| r      regions  soil
//   |     |        curves   bottom, left, right, top
//   +-----+        points   base
//   bottom
//
// Cells grow from h at the top, where the pressure falls at once, to h * coarse at the base.
DefineConstant[
  width  = {0.1,  Min 1e-6, Name "Parameters/width"},   // [m]
  height = {1,    Min 1e-6, Name "Parameters/height"},  // [m]
  h      = {0.01, Min 1e-6, Name "Parameters/h"},       // size of the cells at the top [m]
  coarse = {6,    Min 1,    Name "Parameters/coarse"}   // size at the base, in h
];
Point(1) = {0, 0, 0, coarse * h};
Point(2) = {width, 0, 0, coarse * h};
Point(3) = {width, height, 0, h};
Point(4) = {0, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("soil") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Point("base") = {1};

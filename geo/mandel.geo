// A quarter of a strip of soil under a plate, symmetric about x = 0 and y = 0.
//
//     load
//   +-------+
//   | plate |               regions  soil, plate
//   +-------+ foot          curves   axis, bottom, side, top of the soil; load, foot of the plate
//   +--top--+
// a |       | s             points   middle
// x | soil  | i
// i |       | d
// s +-------+ e
//    bottom
//
// Cells grow from h at the drained side to h * coarse in the middle.
DefineConstant[
  half_width = {1,    Min 1e-6, Name "Parameters/half_width"}, // a [m]
  height     = {0.2,  Min 1e-6, Name "Parameters/height"},     // of the quarter [m]
  h          = {0.05, Min 1e-6, Name "Parameters/h"},          // size of the cells at the side [m]
  coarse     = {2,    Min 1,    Name "Parameters/coarse"}      // size in the middle, in h
];
a = half_width;
t = 0.1 * a;
Point(1) = {0, 0, 0, coarse * h};
Point(2) = {a, 0, 0, h};
Point(3) = {a, height, 0, h};
Point(4) = {0, height, 0, coarse * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Point(11) = {0, height, 0, coarse * h};
Point(12) = {a, height, 0, h};
Point(13) = {a, height + t, 0, coarse * h};
Point(14) = {0, height + t, 0, coarse * h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("plate") = {2};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2};
Physical Curve("top") = {3};
Physical Curve("axis") = {4};
Physical Curve("foot") = {11};
Physical Curve("load") = {13};
Physical Point("middle") = {1};

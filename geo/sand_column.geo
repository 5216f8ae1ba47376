// A column against a wall on a floor, with room to run out to the right and to splash above.
//
//   +- - - - - - - - - - - - - -+  y = height + above
//   |           top             |
//   +-----------+               | e      regions  block, room (a buffer: cells without points)
// a |   block   |     room      | n      curves   bottom, axis, end, top, face
// x |           | face          | d      points   crest (the upper end of the face)
// i |           |               |
// s +-----------+---------------+  y = 0
//            bottom
DefineConstant[
  width  = {0.1,  Min 1e-6, Name "Parameters/width"},  // of the column [m]
  height = {0.1,  Min 1e-6, Name "Parameters/height"}, // of the column [m]
  room   = {0.4,  Min 1e-6, Name "Parameters/room"},   // beside it [m]
  above  = {0.05, Min 1e-6, Name "Parameters/above"},  // above it [m]
  h      = {0.0125, Min 1e-6, Name "Parameters/h"}       // size of the cells [m]
];
Point(1) = {0, 0, 0, h};
Point(2) = {width, 0, 0, h};
Point(3) = {width, height, 0, h};
Point(4) = {0, height, 0, h};
Point(5) = {width + room, 0, 0, h};
Point(6) = {width + room, height + above, 0, h};
Point(7) = {0, height + above, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {2, 5};
Line(6) = {5, 6};
Line(7) = {6, 7};
Line(8) = {7, 4};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8, -3, -2};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{1, 3} = Ceil(width / h - 1e-9) + 1;
Transfinite Curve{2, 4} = Ceil(height / h - 1e-9) + 1;
Transfinite Curve{5} = Ceil(room / h - 1e-9) + 1;
Transfinite Curve{7} = Ceil((width + room) / h - 1e-9) + 1;
Transfinite Curve{6} = Ceil((height + above) / h - 1e-9) + 1;
Transfinite Curve{8} = Ceil(above / h - 1e-9) + 1;
Physical Surface("block") = {1};
Physical Surface("room") = {2};
Physical Curve("bottom") = {1, 5};
Physical Curve("axis") = {4, 8};
Physical Curve("end") = {6};
Physical Curve("top") = {7};
Physical Curve("face") = {2};
Physical Point("crest") = {3};

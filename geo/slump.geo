// A block on a floor with room to spread to the right; half of a symmetric problem.
//
//        top
//   +-----------+ - - - - - - +  y = height
//   |           |             |
// a |   block   |    room     | e      regions  block, room (a buffer: cells without points)
// x |           | face        | n      curves   bottom, axis, end, top, face
// i |           |             | d      points   crest (the upper end of the face)
// s +-----------+-------------+  y = 0
//             bottom
//
// room = 0 leaves the room out, for a grid that is never restored.
DefineConstant[
  half_width = {1,      Min 1e-6, Name "Parameters/half_width"}, // of the block [m]
  height     = {1,      Min 1e-6, Name "Parameters/height"},     // of the block [m]
  room       = {1,      Min 0,    Name "Parameters/room"},       // beside the block [m]
  h          = {0.0625, Min 1e-6, Name "Parameters/h"},          // size of the cells [m]
  quads      = {0, Choices{0, 1}, Name "Parameters/quads"}       // 1: regular quadrilaterals
];
Point(1) = {0, 0, 0, h};
Point(2) = {half_width, 0, 0, h};
Point(3) = {half_width, height, 0, h};
Point(4) = {0, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = Ceil(half_width / h - 1e-9) + 1;
Transfinite Curve{2, 4} = Ceil(height / h - 1e-9) + 1;
Physical Surface("block") = {1};
Physical Curve("face") = {2};
Physical Curve("axis") = {4};
Physical Point("crest") = {3};
If (room > 0)
  Point(5) = {half_width + room, 0, 0, h};
  Point(6) = {half_width + room, height, 0, h};
  Line(5) = {2, 5};
  Line(6) = {5, 6};
  Line(7) = {6, 3};
  Curve Loop(2) = {5, 6, 7, -2};
  Plane Surface(2) = {2};
  Transfinite Curve{5, 7} = Ceil(room / h - 1e-9) + 1;
  Transfinite Curve{6} = Ceil(height / h - 1e-9) + 1;
  Physical Surface("room") = {2};
  Physical Curve("bottom") = {1, 5};
  Physical Curve("end") = {6};
  Physical Curve("top") = {3, 7};
Else
  Physical Curve("bottom") = {1};
  Physical Curve("top") = {3};
EndIf
If (quads)
  Transfinite Surface{:};
  Recombine Surface{:};
EndIf

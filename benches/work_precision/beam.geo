// A cantilever in the room that it bends through.
//
//  +---------------------------+ - - +  y = 0
//  | beam                | tip |     |
//  +---------------------------+     |  y = -depth     regions  beam, tip, room (a buffer)
//  |                                 |                 curves   clamp (x = 0)
//  |              room               |
//  +- - - - - - - - - - - - - - - - -+
//
// room = 0 leaves the room out, for a grid that is never restored.
DefineConstant[
  length = {10,  Min 1e-6, Name "Parameters/length"},  // with the tip [m]
  depth  = {1,   Min 1e-6, Name "Parameters/depth"},   // [m]
  tip    = {0.5, Min 1e-6, Name "Parameters/tip"},     // length of the tip, which carries the load [m]
  room   = {9,   Min 0,    Name "Parameters/room"},    // below the beam [m]
  h      = {0.25, Min 1e-6, Name "Parameters/h"}       // size of the cells [m]
];
a = length - tip;
Point(1) = {0, -depth, 0, h};
Point(2) = {a, -depth, 0, h};
Point(3) = {length, -depth, 0, h};
Point(4) = {length, 0, 0, h};
Point(5) = {a, 0, 0, h};
Point(6) = {0, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(2) = {2};
Transfinite Curve{1, 5} = Ceil(a / h - 1e-9) + 1;
Transfinite Curve{2, 4} = Ceil(tip / h - 1e-9) + 1;
Transfinite Curve{3, 6, 7} = Ceil(depth / h - 1e-9) + 1;
Physical Surface("beam") = {1};
Physical Surface("tip") = {2};
If (room > 0)
  Point(7) = {0, -depth - room, 0, h};
  Point(8) = {length + depth, -depth - room, 0, h};
  Point(9) = {length + depth, 0, 0, h};
  Line(8) = {7, 8};
  Line(9) = {8, 9};
  Line(10) = {9, 4};
  Line(11) = {1, 7};
  Curve Loop(3) = {8, 9, 10, -3, -2, -1, 11};
  Plane Surface(3) = {3};
  Physical Surface("room") = {3};
  Physical Curve("clamp") = {6, 11};
Else
  Physical Curve("clamp") = {6};
EndIf

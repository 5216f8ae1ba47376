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
  h      = {0.25, Min 1e-6, Name "Parameters/h"},      // size of the cells [m]
  quads  = {0, Choices{0, 1}, Name "Parameters/quads"} // 1: regular quadrilaterals
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
  Line(10) = {9, 4};
  Line(11) = {1, 7};
  Physical Curve("clamp") = {6, 11};
  If (quads)
    Point(10) = {a, -depth - room, 0, h};
    Point(11) = {length, -depth - room, 0, h};
    Point(12) = {length + depth, -depth, 0, h};
    Line(12) = {7, 10};
    Line(13) = {10, 11};
    Line(14) = {11, 8};
    Line(15) = {8, 12};
    Line(16) = {12, 9};
    Line(17) = {10, 2};
    Line(18) = {11, 3};
    Line(19) = {3, 12};
    Curve Loop(3) = {12, 17, -1, 11};
    Plane Surface(3) = {3};
    Curve Loop(4) = {13, 18, -2, -17};
    Plane Surface(4) = {4};
    Curve Loop(5) = {14, 15, -19, -18};
    Plane Surface(5) = {5};
    Curve Loop(6) = {19, 16, 10, -3};
    Plane Surface(6) = {6};
    Transfinite Curve{12} = Ceil(a / h - 1e-9) + 1;
    Transfinite Curve{13} = Ceil(tip / h - 1e-9) + 1;
    Transfinite Curve{10, 14, 16, 19} = Ceil(depth / h - 1e-9) + 1;
    Transfinite Curve{11, 15, 17, 18} = Ceil(room / h - 1e-9) + 1;
    Physical Surface("room") = {3, 4, 5, 6};
  Else
    Line(8) = {7, 8};
    Line(9) = {8, 9};
    Curve Loop(3) = {8, 9, 10, -3, -2, -1, 11};
    Plane Surface(3) = {3};
    Physical Surface("room") = {3};
  EndIf
Else
  Physical Curve("clamp") = {6};
EndIf
If (quads)
  Transfinite Surface{:};
  Recombine Surface{:};
EndIf

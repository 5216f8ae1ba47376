// Half of a plane silo with a flat floor and a slot in it, and an empty room below. The sand fills the silo to `height`, or, where `lift` is above 0, it
// is a column half as wide as `column` twice, that far above the floor.
//
//   +- - - - -+  top
//   |   room  | w
//   +---------+ a                    regions  sand, room (a buffer: cells without points)
// a |         | l                    curves   axis, gate, floor, wall, plate, end, ground
// x |  sand   | l
// i |         |
// s +---+-----+  y = 0
//   |gate floor
//   |   | plate
//   |   +-------------+
//   |       room      | end
//   +-----------------+
//         ground
DefineConstant[
  half   = {0.5,  Min 1e-6, Name "Parameters/half"},   // half of the width of the silo [m]
  slot   = {0.15, Min 1e-6, Name "Parameters/slot"},   // half of the width of the slot [m]
  height = {2,    Min 1e-6, Name "Parameters/height"}, // of the sand [m]
  above  = {0.2,  Min 1e-6, Name "Parameters/above"},  // room above it [m]
  lift   = {0,    Min 0,    Name "Parameters/lift"},   // of the column above the floor [m]; 0: the silo is full
  column = {0.3,  Min 1e-6, Name "Parameters/column"}, // half of the width of that column [m]
  plate  = {0.2,  Min 1e-6, Name "Parameters/plate"},  // thickness of the floor [m]
  room   = {1.2,  Min 1e-6, Name "Parameters/room"},   // half of the width below [m]
  depth  = {1.2,  Min 1e-6, Name "Parameters/depth"},  // below the floor [m]
  h      = {0.1,  Min 1e-6, Name "Parameters/h"}       // size of the cells [m]
];
top = lift + height + above;
base = -plate - depth;
Point(1) = {0, 0, 0, h};
Point(2) = {slot, 0, 0, h};
Point(3) = {half, 0, 0, h};
Point(4) = {half, top, 0, h};
Point(5) = {0, top, 0, h};
Point(6) = {slot, -plate, 0, h};
Point(7) = {room, -plate, 0, h};
Point(8) = {room, base, 0, h};
Point(9) = {0, base, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {4, 5};
Line(4) = {2, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 9};
Line(8) = {9, 1};
// The sand, with what of the wall and of the axis it divides.
If (lift > 0)
  Point(10) = {0, lift, 0, h};
  Point(11) = {column, lift, 0, h};
  Point(12) = {column, lift + height, 0, h};
  Point(13) = {0, lift + height, 0, h};
  Line(10) = {10, 11};
  Line(11) = {11, 12};
  Line(12) = {12, 13};
  Line(13) = {13, 10};
  Line(14) = {3, 4};
  Line(15) = {5, 13};
  Line(16) = {10, 1};
  Curve Loop(1) = {10, 11, 12, 13};
  Curve Loop(2) = {1, 2, 14, 3, 15, -12, -11, -10, 16};
  wall[] = {14};
  axis[] = {13, 15, 16};
Else
  Point(10) = {half, height, 0, h};
  Point(11) = {0, height, 0, h};
  Line(10) = {3, 10};
  Line(11) = {10, 11};
  Line(12) = {11, 1};
  Line(13) = {10, 4};
  Line(14) = {5, 11};
  Curve Loop(1) = {1, 2, 10, 11, 12};
  Curve Loop(2) = {13, 3, 14, -11};
  wall[] = {10, 13};
  axis[] = {12, 14};
EndIf
Curve Loop(3) = {8, 1, 4, 5, 6, 7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Physical Surface("sand") = {1};
Physical Surface("room") = {2, 3};
Physical Curve("axis") = {axis[], 8};
Physical Curve("gate") = {1};
Physical Curve("floor") = {2};
Physical Curve("wall") = {wall[]};
Physical Curve("plate") = {4, 5};
Physical Curve("end") = {6};
Physical Curve("ground") = {7};

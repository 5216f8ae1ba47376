// Half of a plane silo with a flat floor and a slot in it. Its floor is the end of the mesh: what leaves through the slot leaves the model.
//
//   +inlet+---+
//   |  feed   |
//   +---------+ w
//   |         | a             regions  bed (sand on the floor), feed, room
// a |  room   | l             curves   axis, wall, roof, floor, gate, inlet
// x |         | l
//   +---------+
//   |  bed    |
//   +---+-----+
//   gate floor
DefineConstant[
  half   = {0.25, Min 1e-6, Name "Parameters/half"},   // half of the width of the silo [m]
  slot   = {0.1,  Min 1e-6, Name "Parameters/slot"},   // half of the width of the slot [m]
  inlet  = {0.125, Min 1e-6, Name "Parameters/inlet"}, // half of the width of the inlet [m]
  height = {1.6,  Min 1e-6, Name "Parameters/height"}, // of the silo [m]
  layer  = {0.1,  Min 1e-6, Name "Parameters/layer"},  // thickness of bed and feed [m]
  h      = {0.05, Min 1e-6, Name "Parameters/h"}       // size of the cells [m]
];
Point(1) = {0, 0, 0, h};
Point(2) = {slot, 0, 0, h};
Point(3) = {half, 0, 0, h};
Point(4) = {half, layer, 0, h};
Point(5) = {half, height - layer, 0, h};
Point(6) = {half, height, 0, h};
Point(7) = {0, height, 0, h};
Point(8) = {0, height - layer, 0, h};
Point(9) = {0, layer, 0, h};
Point(10) = {inlet, height, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {10, 7};
Line(12) = {6, 10};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 1};
Line(10) = {4, 9};
Line(11) = {5, 8};
Curve Loop(1) = {1, 2, 3, 10, 9};
Curve Loop(2) = {4, 11, 8, -10};
Curve Loop(3) = {5, 12, 6, 7, -11};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Physical Surface("bed") = {1};
Physical Surface("room") = {2};
Physical Surface("feed") = {3};
Physical Curve("gate") = {1};
Physical Curve("floor") = {2};
Physical Curve("wall") = {3, 4, 5};
Physical Curve("inlet") = {6};
Physical Curve("roof") = {12};
Physical Curve("axis") = {7, 8, 9};

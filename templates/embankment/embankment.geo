// Half of an embankment on clay, to the right of its axis, built in three lifts.
//
//   |                 air                      |
//   +--------- crest -+                        |
//   |     lift3        \                       |
//   +-------------------+                      |        regions  clay, lift1, lift2, lift3, air
//   |     lift2          \                     |        curves   axis, side, bottom
//   +---------------------+                    |        points   ground, middle
//   |     lift1            \                   |
//   +-- ground --------------------------------+ 0
//   | axis         clay                        | side
//   +-- middle                                 |
//   +------------------------------------------+ -depth
//                bottom
//
// The lifts are empty until they are placed. Gmsh shows all this, and its numbers may be changed there: gmsh embankment.geo
DefineConstant[
  foot   = {8,   Min 1e-6, Name "Parameters/foot"},    // half of the width at the ground [m]
  slope  = {2,   Min 0,    Name "Parameters/slope"},   // metres sideways for a metre up
  lift   = {0.8, Min 1e-6, Name "Parameters/lift"},    // thickness of a lift [m]
  depth  = {4,   Min 1e-6, Name "Parameters/depth"},   // of the clay [m]
  width  = {20,  Min 1e-6, Name "Parameters/width"},   // of the clay from the axis on [m]
  air    = {0.8, Min 1e-6, Name "Parameters/air"},     // height of the room above the embankment [m]
  h      = {0.4, Min 1e-6, Name "Parameters/h"},       // size of the cells [m]
  coarse = {3,   Min 1,    Name "Parameters/coarse"}   // size at the side, in h
];
top = 3 * lift + air;
Point(1) = {0, -depth, 0, h};
Point(2) = {width, -depth, 0, coarse * h};
Point(3) = {width, 0, 0, coarse * h};
Point(4) = {width, top, 0, coarse * h};
Point(5) = {0, top, 0, coarse * h};
Point(6) = {0, -depth / 2, 0, h};
For i In {0:3}
  Point(10 + i) = {0, i * lift, 0, h};
  Point(20 + i) = {foot - i * lift * slope, i * lift, 0, h};
  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {0:2}
  Line(40 + i) = {10 + i, 11 + i};
  Line(50 + i) = {20 + i, 21 + i};
  Curve Loop(60 + i) = {30 + i, 50 + i, -(31 + i), -(40 + i)};
  Plane Surface(60 + i) = {60 + i};
EndFor
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 20};
Line(4) = {10, 6};
Line(5) = {6, 1};
Line(6) = {3, 4};
Line(7) = {4, 5};
Line(8) = {5, 13};
Curve Loop(1) = {1, 2, 3, -30, 4, 5};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 6, 7, 8, 33, -52, -51, -50};
Plane Surface(2) = {2};

// What case.yaml calls them.
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("lift1") = {60};
Physical Surface("lift2") = {61};
Physical Surface("lift3") = {62};
Physical Curve("axis") = {4, 5, 8, 40, 41, 42};
Physical Curve("side") = {2, 6};
Physical Curve("bottom") = {1};
Physical Point("ground") = {10};
Physical Point("middle") = {6};

// A blade behind a heap of soil on a floor.
//
//   +----------------------------------------+ height
//   |   |  |                 room            | e
//   |   |  |\                                | n       regions  soil, room (a buffer), blade
//   |   |  |   \  soil                       | d       curves   floor, end
//   |   |  |      \                          |
//   +---+--+--------+------------------------+ 0
//  -behind 0      floor                      way
//
// The blade has a mesh of its own, which lies over the cells of the room and a little above the floor.
DefineConstant[
  heap      = {0.6,  Min 1e-6, Name "Parameters/heap"},      // height of the heap at the blade [m]
  slope     = {25,   Min 1, Max 80, Name "Parameters/slope"}, // of the heap [degrees]
  way       = {3.2,  Min 1e-6, Name "Parameters/way"},       // length of the floor before the blade [m]
  behind    = {0.5,  Min 1e-6, Name "Parameters/behind"},    // length of the floor behind the face of the blade [m]
  height    = {1,    Min 1e-6, Name "Parameters/height"},    // of the room [m]
  thickness = {0.2,  Min 1e-6, Name "Parameters/thickness"}, // of the blade [m]
  h         = {0.1,  Min 1e-6, Name "Parameters/h"}          // size of the cells [m]
];
toe = heap / Tan(slope * Pi / 180);
Point(1) = {0, 0, 0, h};
Point(2) = {toe, 0, 0, h};
Point(3) = {0, heap, 0, h};
Point(4) = {way, 0, 0, h};
Point(5) = {way, height, 0, h};
Point(6) = {-behind, height, 0, h};
Point(7) = {-behind, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Line(4) = {2, 4};
Line(5) = {4, 5};
Line(6) = {5, 6};
Line(7) = {6, 7};
Line(8) = {7, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Curve Loop(2) = {4, 5, 6, 7, 8, -3, -2};
Plane Surface(2) = {2};
Point(11) = {-thickness, 0, 0, h};
Point(12) = {0, 0, 0, h};
Point(13) = {0, 0.95 * height, 0, h};
Point(14) = {-thickness, 0.95 * height, 0, h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Physical Surface("soil") = {1};
Physical Surface("room") = {2};
Physical Surface("blade") = {3};
Physical Curve("floor") = {1, 4, 8};
Physical Curve("end") = {5, 7};

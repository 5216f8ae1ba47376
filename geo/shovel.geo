// A blade in a trench, pushed into the soil before it.
//
//            |  |
//            |  |              air
//    air     |  +----------------------------+ 0       regions  soil, air, blade
//            |  |                            | s       curves   bottom, side
//   +--------+--+           soil             | i
//   |  floor of the trench, -cut             | d
//   |                                        | e
//   +----------------------------------------+ -cut - beneath
//   -room       0        bottom              length
//
// The blade has a mesh of its own, which lies over the cells of the air.
DefineConstant[
  cut       = {0.5,  Min 1e-6, Name "Parameters/cut"},       // depth of the trench, and of the blade below the surface [m]
  beneath   = {0.5,  Min 1e-6, Name "Parameters/beneath"},   // soil beneath the trench [m]
  length    = {3,    Min 1e-6, Name "Parameters/length"},    // of the soil before the blade [m]
  room      = {0.6,  Min 1e-6, Name "Parameters/room"},      // of the trench behind the face of the soil [m]
  above     = {0.8,  Min 1e-6, Name "Parameters/above"},     // room for the heap, and height of the blade, above the surface [m]
  thickness = {0.2,  Min 1e-6, Name "Parameters/thickness"}, // of the blade [m]
  h         = {0.1,  Min 1e-6, Name "Parameters/h"}          // size of the cells around the way of the blade [m]
];
base = -cut - beneath;
Point(1) = {-room, base, 0, 2 * h};
Point(2) = {length, base, 0, 2 * h};
Point(3) = {length, 0, 0, 2 * h};
Point(4) = {0, 0, 0, h};
Point(5) = {0, -cut, 0, h};
Point(6) = {-room, -cut, 0, h};
Point(7) = {length, above, 0, 2 * h};
Point(8) = {-room, above, 0, 2 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {3, 7};
Line(8) = {7, 8};
Line(9) = {8, 6};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 9, -5, -4, -3};
Plane Surface(2) = {2};
Point(11) = {-thickness, -cut, 0, h};
Point(12) = {0, -cut, 0, h};
Point(13) = {0, 0.95 * above, 0, h};
Point(14) = {-thickness, 0.95 * above, 0, h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("blade") = {3};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 6, 7, 9};

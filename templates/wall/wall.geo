// A smooth rigid wall beside soil on a smooth base.
//
//       |wall|             air                      regions  soil, wall, air (a buffer)
//  air  |    +-------------------------+ height     curves   bottom, side
//       |    |                         | s
//       |    |         soil            | i
//       |    |                         | d
//  +----+----+-------------------------+ e
//            0        bottom           length
//
// The wall has a mesh of its own, which lies over the cells of the air beside the soil. Gmsh shows all this, and its numbers may be changed there:
// gmsh wall.geo
DefineConstant[
  height    = {4,   Min 1e-6, Name "Parameters/height"},    // of the soil [m]
  length    = {6,   Min 1e-6, Name "Parameters/length"},    // of the soil [m]
  thickness = {0.8, Min 1e-6, Name "Parameters/thickness"}, // of the wall [m]
  room      = {1.5, Min 1e-6, Name "Parameters/room"},      // behind the soil's face, where the wall stands and goes when it is moved away [m]
  above     = {1,   Min 1e-6, Name "Parameters/above"},     // room that soil may heave into [m]
  h         = {0.5, Min 1e-6, Name "Parameters/h"}          // size of the cells [m]
];
roof = height + above;
Point(1) = {0, 0, 0, h};
Point(2) = {length, 0, 0, h};
Point(3) = {length, height, 0, h};
Point(4) = {0, height, 0, h};
Point(5) = {length, roof, 0, h};
Point(6) = {-room, roof, 0, h};
Point(7) = {-room, 0, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 7};
Line(8) = {7, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8, -4, -3};
Plane Surface(2) = {2};

// The wall, as high as the soil may come.
Point(11) = {-thickness, 0, 0, h};
Point(12) = {0, 0, 0, h};
Point(13) = {0, roof - 0.5 * above, 0, h};
Point(14) = {-thickness, roof - 0.5 * above, 0, h};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};

// What case.yaml calls them.
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Surface("wall") = {3};
Physical Curve("bottom") = {1, 8};
Physical Curve("side") = {2, 5};

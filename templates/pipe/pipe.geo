// A pipe on the seabed, with a mesh of its own over the cells of clay and water.
//
//  +--------------__------------------------------+ water
//  |   water     /  \                             |
//  |            |pipe|  -> it goes `way` this way |         regions  clay, water, pipe
//  +-------------\__/-----------------------------+ 0       curves   side, bottom
//  |                                              |
//  |               clay                           | side
//  |                                              |
//  +----------------------------------------------+ -depth
//                    bottom
//
// The pipe begins on the seabed, at x = 0. `water` are empty cells that clay may heave into.
// Gmsh shows all this, and its numbers may be changed there: gmsh pipe.geo
DefineConstant[
  diameter = {0.8,  Min 1e-6, Name "Parameters/diameter"},  // of the pipe, D [m]
  way      = {0.8,  Min 1e-6, Name "Parameters/way"},       // how far it is moved sideways [m]
  aside    = {2.4,  Min 1e-6, Name "Parameters/aside"},     // clay before and behind the way [m]
  depth    = {2.4,  Min 1e-6, Name "Parameters/depth"},     // of the clay [m]
  water    = {0.6,  Min 1e-6, Name "Parameters/water"},     // height of the room above the clay [m]
  deep     = {0.35, Min 1e-6, Name "Parameters/deep"},      // cells are fine down to there [m]
  heave    = {0.4,  Min 1e-6, Name "Parameters/heave"},     // and up to there [m]
  h        = {0.1,  Min 1e-6, Name "Parameters/h"},         // size of the cells around the pipe [m]
  coarse   = {5,    Min 1,    Name "Parameters/coarse"}     // largest size, in h
];
r = diameter / 2;

// Clay, and the water above it.
Point(1) = {-aside, -depth, 0};
Point(2) = {way + aside, -depth, 0};
Point(3) = {way + aside, 0, 0};
Point(4) = {-aside, 0, 0};
Point(5) = {way + aside, water, 0};
Point(6) = {-aside, water, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};

// The pipe.
Point(11) = {0, r, 0};
Point(12) = {0, 0, 0};
Point(13) = {r, r, 0};
Point(14) = {0, 2 * r, 0};
Point(15) = {-r, r, 0};
Circle(11) = {12, 11, 13};
Circle(12) = {13, 11, 14};
Circle(13) = {14, 11, 15};
Circle(14) = {15, 11, 12};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};

// Sizes of cells: h in a box around the way of the pipe, growing outside of it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1.2 * r;
Field[1].XMax = way + 2.5 * r;
Field[1].YMin = -deep;
Field[1].YMax = heave;
Field[1].Thickness = 2 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("clay") = {1};
Physical Surface("water") = {2};
Physical Surface("pipe") = {3};
Physical Curve("side") = {2, 4, 5, 7};
Physical Curve("bottom") = {1};

// A slope, and the plain in front of it that it may run out over.
//
//  +------------------------------------------------+ height + headroom
//  |                     air                        |
//  +---------------+                                | height
//  |    crest       \                               |
//  |                 \  slope                       |      regions  soil, air
//  | back             \                             | end  curves   bottom, back, end, crest
//  |                   +----------------------------+ 0
//  |       soil                   plain             |
//  +------------------------------------------------+ -base
//                       bottom
//
// The toe is at x = 0, the slope rises to the left. `air` are empty cells that soil may move into.
// Gmsh shows all this, and its numbers may be changed there: gmsh slope.geo
DefineConstant[
  height   = {10,     Min 1e-6, Name "Parameters/height"},   // of the slope, H [m]
  angle    = {26.565, Min 1, Max 90, Name "Parameters/angle"}, // of the slope to the horizontal [degrees]: 26.565 is 1 : 2
  base     = {5,      Min 1e-6, Name "Parameters/base"},     // soil below the plain [m]
  crest    = {12,     Min 1e-6, Name "Parameters/crest"},    // length of the crest [m]
  plain    = {20,     Min 1e-6, Name "Parameters/plain"},    // length of the plain, the room for the run-out [m]
  headroom = {1,      Min 1e-6, Name "Parameters/headroom"}, // air above the crest [m]
  h        = {1.25,   Min 1e-6, Name "Parameters/h"},        // size of the cells in the slope and in the run-out [m]
  coarse   = {1.5,    Min 1,    Name "Parameters/coarse"}    // size at the back, at the bottom and at the top, in h
];
run = angle == 90 ? 0 : height / Tan(angle * Pi / 180);
left = -run - crest;
Point(1) = {left, -base, 0};
Point(2) = {plain, -base, 0};
Point(3) = {plain, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {-run, height, 0};
Point(6) = {left, height, 0};
Point(7) = {plain, height + headroom, 0};
Point(8) = {left, height + headroom, 0};
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

// Sizes of cells: h up to a third of the height from the slope, growing to h * coarse farther away.
Field[1] = Distance;
Field[1].CurvesList = {4};
Field[1].Sampling = 100;
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = h;
Field[2].SizeMax = coarse * h;
Field[2].DistMin = height / 3;
Field[2].DistMax = height;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Curve("bottom") = {1};
Physical Curve("end") = {2, 7};
Physical Curve("crest") = {5};
Physical Curve("back") = {6, 9};

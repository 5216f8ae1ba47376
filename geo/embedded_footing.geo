// A footing pushed into clay: half of it, beside its axis. In plane strain it is a strip.
//
//    air  |   side
//  +--+---+ 0                        regions  clay, air, footing
//  |__|   |                          curves   axis, side, bottom
//  |      |
//  | clay |
//  +------+ -depth
//   bottom
//
// Cells are of size h in a strip along the way of the footing and grow with the distance from it, to h * coarse at most.
DefineConstant[
  diameter  = {3,    Min 1e-6, Name "Parameters/diameter"},  // of the footing [m]
  thickness = {1,    Min 1e-6, Name "Parameters/thickness"}, // of the footing [m]
  way       = {6,    Min 1e-6, Name "Parameters/way"},       // that its base will go below the surface [m]
  beneath   = {6,    Min 1e-6, Name "Parameters/beneath"},   // clay beneath the end of the way [m]
  width     = {10,   Min 1e-6, Name "Parameters/width"},     // of the clay from the axis on [m]
  air       = {2,    Min 1e-6, Name "Parameters/air"},       // height that soil may heave into [m]
  fine      = {1,    Min 1e-6, Name "Parameters/fine"},      // width of the strip of small cells, in diameters
  h         = {0.25, Min 1e-6, Name "Parameters/h"},         // size of the cells around the footing [m]
  coarse    = {5,    Min 1, Name "Parameters/coarse"}        // largest size, in h
];
depth = way + beneath;
radius = diameter / 2;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width, air, 0};
Point(6) = {0, air, 0};
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
Point(11) = {0, 0, 0};
Point(12) = {radius, 0, 0};
Point(13) = {radius, thickness, 0};
Point(14) = {0, thickness, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = fine * diameter;
Field[1].YMin = -way - diameter / 2;
Field[1].YMax = air;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("footing") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};

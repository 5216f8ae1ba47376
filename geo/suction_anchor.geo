// A caisson pushed into clay, beside its axis: a wall under a lid.
//
//  +-------+
//  +-----+ |   air
//        | |      side
//  +-----+-+------+ 0                regions  clay, air, caisson
//  |              |                  curves   axis, side, bottom
//  |     clay     |
//  +--------------+ -depth
//      bottom
//
// Cells are of size h around the way of the caisson and grow with the distance from it, to h * coarse at most.
DefineConstant[
  diameter = {3,    Min 1e-6, Name "Parameters/diameter"}, // of the caisson, outside [m]
  wall     = {0.06, Min 1e-6, Name "Parameters/wall"},     // its thickness, and that of the lid [m]
  length   = {3,    Min 1e-6, Name "Parameters/length"},   // of the wall below the lid [m]
  way      = {3,    Min 1e-6, Name "Parameters/way"},      // that the tip of the wall will go below the surface [m]
  beneath  = {3,    Min 1e-6, Name "Parameters/beneath"},  // clay beneath the end of the way [m]
  width    = {5,    Min 1e-6, Name "Parameters/width"},    // of the clay from the axis on [m]
  air      = {1,    Min 1e-6, Name "Parameters/air"},      // height that soil may heave into [m]
  fine     = {0.1,  Min 1e-6, Name "Parameters/fine"},     // width of the strip of small cells beside the wall, in diameters
  h        = {0.12,  Min 1e-6, Name "Parameters/h"},        // size of the cells around the wall [m]
  coarse   = {4,    Min 1, Name "Parameters/coarse"}       // largest size, in h
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
Point(11) = {radius - wall, 0, 0};
Point(12) = {radius, 0, 0};
Point(13) = {radius, length + wall, 0};
Point(14) = {0, length + wall, 0};
Point(15) = {0, length, 0};
Point(16) = {radius - wall, length, 0};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 16};
Line(16) = {16, 11};
Curve Loop(3) = {11, 12, 13, 14, 15, 16};
Plane Surface(3) = {3};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = radius + fine * diameter;
Field[1].YMin = -way - diameter / 4;
Field[1].YMax = air;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("caisson") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};

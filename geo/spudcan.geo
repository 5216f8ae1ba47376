// A spudcan pushed into clay: half of its section, beside its axis.
//
//    air    |
//  |\___    |
//  |    |   |                          the widest section, at y = 0, is where its depth is measured from
//  |___-    |
//  ---------+ -cone                    regions  clay, air, can
//  |        | side                     curves   axis, side, bottom
//  |  clay  |
//  +--------+ -cone - depth
//   bottom
//
// The surface of the clay is at y = 0; the can begins above it with its tip at y = 0. Cells are of size h in a strip along the way of the can and grow with the
// distance from it, to h * coarse at most.
DefineConstant[
  diameter = {12,  Min 1e-6, Name "Parameters/diameter"}, // of the can [m]
  cone     = {13,  Min 0, Max 60, Name "Parameters/cone"}, // inclination of its underside [degrees]
  rim      = {0.6, Min 1e-6, Name "Parameters/rim"},      // height of its edge [m]
  top      = {13,  Min 0, Max 60, Name "Parameters/top"}, // inclination of its upper side [degrees]
  way      = {18,  Min 1e-6, Name "Parameters/way"},      // that its widest section will go below the surface [m]
  beneath  = {18,  Min 1e-6, Name "Parameters/beneath"},  // clay beneath the end of the way [m]
  width    = {42,  Min 1e-6, Name "Parameters/width"},    // of the clay from the axis on [m]
  air      = {4,   Min 1e-6, Name "Parameters/air"},      // height that soil may heave into [m]
  fine     = {0.9, Min 1e-6, Name "Parameters/fine"},     // width of the strip of small cells, in diameters
  h        = {0.6, Min 1e-6, Name "Parameters/h"},        // size of the cells around the can [m]
  coarse   = {6,   Min 1, Name "Parameters/coarse"}       // largest size, in h
];
depth = way + beneath;
radius = diameter / 2;
tip = radius * Tan(cone * Pi / 180);
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
Point(12) = {radius, tip, 0};
Point(13) = {radius, tip + rim, 0};
Point(14) = {0, tip + rim + radius * Tan(top * Pi / 180), 0};
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
Physical Surface("can") = {3};
Physical Curve("axis") = {4, 7};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};

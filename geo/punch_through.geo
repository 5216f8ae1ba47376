// Half of a footing on two layers of clay, symmetric about x = 0. In axisymmetry the same section is a round footing.
//
//   +-------+
//   |footing|  air
//   +-------+------------+ 0         regions  upper, lower, air, footing
//   |       upper        |           curves   axis, side, bottom
//   +--------------------+ -upper
//   |       lower        |
//   +--------------------+ -depth
//          bottom
//
// Cells are of size h in a strip along the way of the footing and grow with the distance from it, to h * coarse at most.
DefineConstant[
  half_width = {0.5, Min 1e-6, Name "Parameters/half_width"}, // B/2 or the radius [m]
  upper      = {0.5, Min 1e-6, Name "Parameters/upper"},      // thickness of the upper layer [m]
  way        = {1,   Min 1e-6, Name "Parameters/way"},        // that the base will go below the surface [m]
  beneath    = {2,   Min 1e-6, Name "Parameters/beneath"},    // clay beneath the end of the way [m]
  width      = {4,   Min 1e-6, Name "Parameters/width"},      // of the clay from the axis on [m]
  air        = {0.5, Min 1e-6, Name "Parameters/air"},        // height that soil may heave into [m]
  fine       = {2,   Min 1e-6, Name "Parameters/fine"},       // width of the strip of small cells, in half_width
  h          = {0.1, Min 1e-6, Name "Parameters/h"},          // size of the cells around the footing [m]
  coarse     = {5,   Min 1, Name "Parameters/coarse"}         // largest size, in h
];
depth = way + beneath;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width, air, 0};
Point(6) = {0, air, 0};
Point(7) = {0, -upper, 0};
Point(8) = {width, -upper, 0};
Line(1) = {1, 2};
Line(2) = {8, 3};
Line(3) = {3, 4};
Line(4) = {4, 7};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Line(8) = {7, 8};
Line(9) = {2, 8};
Line(10) = {7, 1};
Curve Loop(1) = {8, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Curve Loop(4) = {1, 9, -8, 10};
Plane Surface(4) = {4};
Point(11) = {0, 0, 0};
Point(12) = {half_width, 0, 0};
Point(13) = {half_width, way + air, 0};
Point(14) = {0, way + air, 0};
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
Field[1].XMax = fine * half_width;
Field[1].YMin = -way - half_width;
Field[1].YMax = air;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("upper") = {1};
Physical Surface("lower") = {4};
Physical Surface("air") = {2};
Physical Surface("footing") = {3};
Physical Curve("axis") = {4, 7, 10};
Physical Curve("side") = {2, 5, 9};
Physical Curve("bottom") = {1};

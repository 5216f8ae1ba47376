// A cone penetrometer in clay, beside its axis. It is some way deep already: the clay around it begins at its face.
//
//        | | air
//        | +---------+ 0              regions  clay, air, hole, tip, sleeve
//   hole | |         |                curves   axis, side, bottom
//        |/   clay   | side
//        |           |
//        +-----------+ -depth
//           bottom
//
// Tip and sleeve are two bodies with meshes of their own, so that each has its force; the hole is empty cells beneath them. Cells are of
// size h in a strip along the way of the cone and grow with the distance from it, to h * coarse at most.
// Gmsh shows all this, and its numbers may be changed there: gmsh cpt.geo
DefineConstant[
  radius  = {0.018, Min 1e-6, Name "Parameters/radius"},  // of the cone [m]
  angle   = {60,    Min 1, Max 179, Name "Parameters/angle"}, // at the tip [degrees]
  deep    = {0.18,  Min 1e-6, Name "Parameters/deep"},    // depth of its shoulder at first [m]
  way     = {0.18,  Min 1e-6, Name "Parameters/way"},     // that it will go [m]
  beneath = {0.2,   Min 1e-6, Name "Parameters/beneath"}, // clay beneath the end of the way [m]
  width   = {0.4,   Min 1e-6, Name "Parameters/width"},   // of the clay from the axis on [m]
  air     = {0.054, Min 1e-6, Name "Parameters/air"},     // height that clay may heave into [m]
  fine    = {2,     Min 1e-6, Name "Parameters/fine"},    // width of the strip of small cells, in radii
  h       = {0.006, Min 1e-6, Name "Parameters/h"},       // size of the cells around the cone [m]
  coarse  = {8,     Min 1, Name "Parameters/coarse"}      // largest size, in h
];
cone = radius / Tan(angle * Pi / 360);
joint = 0.02 * radius;      // between tip and sleeve
depth = deep + cone + way + beneath;
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {radius, 0, 0};
Point(5) = {radius, -deep, 0};
Point(6) = {0, -deep - cone, 0};
Point(7) = {width, air, 0};
Point(8) = {radius, air, 0};
Point(9) = {0, air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {3, 7};
Line(8) = {7, 8};
Line(9) = {8, 4};
Line(10) = {8, 9};
Line(11) = {9, 6};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 8, 9, -3};
Plane Surface(2) = {2};
Curve Loop(3) = {10, 11, -5, -4, -9};
Plane Surface(3) = {3};

Point(11) = {0, -deep - cone, 0};
Point(12) = {radius, -deep, 0};
Point(13) = {0, -deep, 0};
Line(21) = {11, 12};
Line(22) = {12, 13};
Line(23) = {13, 11};
Curve Loop(4) = {21, 22, 23};
Plane Surface(4) = {4};
Point(21) = {0, -deep + joint, 0};
Point(22) = {radius, -deep + joint, 0};
Point(23) = {radius, way + 2 * air, 0};
Point(24) = {0, way + 2 * air, 0};
Line(31) = {21, 22};
Line(32) = {22, 23};
Line(33) = {23, 24};
Line(34) = {24, 21};
Curve Loop(5) = {31, 32, 33, 34};
Plane Surface(5) = {5};

Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = fine * radius;
Field[1].YMin = -deep - cone - way - radius;
Field[1].YMax = air;
Field[1].Thickness = 4 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("hole") = {3};
Physical Surface("tip") = {4};
Physical Surface("sleeve") = {5};
Physical Curve("axis") = {6, 11};
Physical Curve("side") = {2, 7};
Physical Curve("bottom") = {1};

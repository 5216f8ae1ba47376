// A mat on clay or in it, the whole of its section.
//
//                air
//        +----------------+                          skirt, wall: 0 and 0: a flat mat on the surface
//  +-----+      mat       +-----+ 0                  skirt > 0, wall > 0: with skirts, a plug of clay between them
//  |     | |+----------+| |     |                    skirt > 0, wall = 0: solid down to the tips of the skirts
//  |     |_|   plug     |_|     |
//  |           clay             | side    regions  clay, air, mat; below the surface hole
//  +----------------------------+ -depth  curves   side, bottom
//             bottom
//
// What of the mat is below the surface lies on the hole, which is part of the grid. Cells are of size h near the mat and grow with the distance from it,
// to h * coarse at most.
DefineConstant[
  width  = {6,    Min 1e-6, Name "Parameters/width"},   // of the mat [m]
  plate  = {0.6,  Min 1e-6, Name "Parameters/plate"},   // thickness of its plate, above the surface [m]
  skirt  = {0,    Min 0,    Name "Parameters/skirt"},   // depth of the skirts [m]
  wall   = {0,    Min 0,    Name "Parameters/wall"},    // their thickness, 0: solid [m]
  depth  = {10,   Min 1e-6, Name "Parameters/depth"},   // of the clay [m]
  aside  = {12,   Min 1e-6, Name "Parameters/aside"},   // clay beside the mat [m]
  air    = {1.5,  Min 1e-6, Name "Parameters/air"},     // height that soil may heave into [m]
  h      = {0.3,  Min 1e-6, Name "Parameters/h"},       // size of the cells at the edges of the mat [m]
  under  = {1,    Min 1, Name "Parameters/under"},      // size around the mat, in h
  coarse = {8,    Min 1, Name "Parameters/coarse"}      // largest size, in h
];
half = width / 2;
out = half + aside;
Point(1) = {-out, -depth, 0};
Point(2) = {out, -depth, 0};
Point(3) = {out, 0, 0};
Point(4) = {-out, 0, 0};
Point(5) = {out, air, 0};
Point(6) = {-out, air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};

// The outline below the plate from the right to the left, twice: as the edge of the clay and with a mesh of its own.
For k In {0:1}
  p = 20 + 20 * k;
  Point(p) = {half, 0, 0};
  Point(p + 1) = {-half, 0, 0};
  If (skirt == 0)
    Line(p) = {p, p + 1};
    outline~{k} = {p};
  Else
    Point(p + 2) = {half, -skirt, 0};
    Point(p + 3) = {-half, -skirt, 0};
    Line(p) = {p, p + 2};
    Line(p + 1) = {p + 3, p + 1};
    If (wall == 0)
      Line(p + 2) = {p + 2, p + 3};
      outline~{k} = {p, p + 2, p + 1};
    Else
      Point(p + 4) = {half - wall, -skirt, 0};
      Point(p + 5) = {half - wall, 0, 0};
      Point(p + 6) = {-half + wall, 0, 0};
      Point(p + 7) = {-half + wall, -skirt, 0};
      Line(p + 2) = {p + 2, p + 4};
      Line(p + 3) = {p + 4, p + 5};
      Line(p + 4) = {p + 5, p + 6};
      Line(p + 5) = {p + 6, p + 7};
      Line(p + 6) = {p + 7, p + 3};
      outline~{k} = {p, p + 2, p + 3, p + 4, p + 5, p + 6, p + 1};
    EndIf
  EndIf
EndFor
Line(10) = {3, 20};
Line(11) = {21, 4};
Curve Loop(1) = {1, 2, 10, outline_0[], 11, 4};
Plane Surface(1) = {1};
If (skirt == 0)
  Curve Loop(2) = {10, outline_0[], 11, -7, -6, -5};
Else
  If (wall == 0)
    Line(12) = {20, 21};
    Curve Loop(2) = {10, 12, 11, -7, -6, -5};
    Curve Loop(4) = {outline_0[], -12};
    Plane Surface(4) = {4};
  Else
    Line(12) = {20, 25};
    Line(13) = {26, 21};
    Curve Loop(2) = {10, 12, 24, 13, 11, -7, -6, -5};
    Curve Loop(4) = {20, 22, 23, -12};
    Plane Surface(4) = {4};
    Curve Loop(5) = {25, 26, 21, -13};
    Plane Surface(5) = {5};
  EndIf
EndIf
Plane Surface(2) = {2};
Point(60) = {half, plate, 0};
Point(61) = {-half, plate, 0};
Line(60) = {41, 61};
Line(61) = {61, 60};
Line(62) = {60, 40};
Curve Loop(3) = {outline_1[], 60, 61, 62};
Plane Surface(3) = {3};

// Sizes by the distance from the edges, and around the mat.
Point(70) = {half, -skirt, 0};
Point(71) = {-half, -skirt, 0};
If (skirt > 0)
  Point(72) = {half, 0, 0};
  Point(73) = {-half, 0, 0};
  Line(70) = {70, 72};
  Line(71) = {71, 73};
EndIf
Field[1] = Box;
Field[1].VIn = under * h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1.25 * half;
Field[1].XMax = 1.25 * half;
Field[1].YMin = -skirt - 0.5 * half;
Field[1].YMax = plate;
Field[1].Thickness = 3 * coarse * h;
Field[2] = Distance;
Field[2].PointsList = {70, 71};
If (skirt > 0)
  Field[2].CurvesList = {70, 71};
  Field[2].Sampling = Ceil(2 * skirt / h);
EndIf
Field[3] = Threshold;
Field[3].InField = 2;
Field[3].SizeMin = h;
Field[3].SizeMax = coarse * h;
Field[3].DistMin = 2 * h;
Field[3].DistMax = 2 * h + 5 * (coarse - 1) * h + 1e-3 * h;
Field[4] = Min;
Field[4].FieldsList = {1, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("mat") = {3};
If (skirt > 0)
  If (wall == 0)
    Physical Surface("hole") = {4};
  Else
    Physical Surface("hole") = {4, 5};
  EndIf
EndIf
Physical Curve("side") = {2, 4, 5, 7};
Physical Curve("bottom") = {1};
Physical Curve("top") = {61};

// A slide on the seabed and a pipe ahead of it, that has a mesh of its own.
//
//  +- - - - - - - - - - - - - - - - - - - - - - -+
//  |                      .  room                |       regions  slide, room (a buffer), pipe
//  +-----------------+      ___                  |       curves   seabed, ends, top
//  |     slide       |     /   \                 |
//  |        ->       |    |pipe |                |
//  |                 |     \___/                 |
//  +-----------------+------ gap ----------------+ 0
//       seabed             0
//
// Cells are of size h around the pipe, and h * coarse far from it.
DefineConstant[
  diameter = {1,   Min 1e-6, Name "Parameters/diameter"}, // of the pipe [m]
  gap      = {1.5, Min 0,    Name "Parameters/gap"},      // between the pipe and the seabed [m]
  length   = {8,   Min 1e-6, Name "Parameters/length"},   // of the slide [m]
  height   = {4,   Min 1e-6, Name "Parameters/height"},   // of the slide [m]
  ahead    = {0.2, Min 1e-6, Name "Parameters/ahead"},    // of the slide, up to the pipe [m]
  behind   = {4,   Min 1e-6, Name "Parameters/behind"},   // room behind the pipe [m]
  above    = {2,   Min 1e-6, Name "Parameters/above"},    // room above the slide [m]
  h        = {0.2, Min 1e-6, Name "Parameters/h"},        // size of the cells around the pipe [m]
  coarse   = {2,   Min 1,    Name "Parameters/coarse"}    // largest size, in h
];
r = diameter / 2;
front = -r - ahead;
back = front - length;
end = r + behind;
Point(1) = {back, 0, 0};
Point(2) = {front, 0, 0};
Point(3) = {front, height, 0};
Point(4) = {back, height, 0};
Point(5) = {end, 0, 0};
Point(6) = {end, height + above, 0};
Point(7) = {back, height + above, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {2, 5};
Line(6) = {5, 6};
Line(7) = {6, 7};
Line(8) = {7, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8, -3, -2};
Plane Surface(2) = {2};
Point(11) = {0, gap, 0};
Point(12) = {r, gap + r, 0};
Point(13) = {0, gap + diameter, 0};
Point(14) = {-r, gap + r, 0};
Point(15) = {0, gap + r, 0};
Circle(11) = {11, 15, 12};
Circle(12) = {12, 15, 13};
Circle(13) = {13, 15, 14};
Circle(14) = {14, 15, 11};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1.5 * diameter;
Field[1].XMax = 2 * diameter;
Field[1].YMin = gap - 0.5 * diameter;
Field[1].YMax = gap + 1.5 * diameter;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("slide") = {1};
Physical Surface("room") = {2};
Physical Surface("pipe") = {3};
Physical Curve("seabed") = {1, 5};
Physical Curve("ends") = {4, 6, 8};
Physical Curve("top") = {7};

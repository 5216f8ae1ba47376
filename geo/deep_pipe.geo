// Half of a rigid pipe deep in soil, symmetric about x = 0, with a mesh of its own.
//
//     +-----------------------+
//     |                       |       regions  soil, hole, pipe
//   a |                       | r     curves   axis, rim, core
//   x |                       | i
//     +--__                   | m
//   c |    \                  |
//   o |pipe |     soil        |
//   r |    /                  |
//   e +--~~                   |
//   a |                       |
//   x |                       |
//     +-----------------------+
//
// The pipe lies on the hole, which is part of the grid: soil may follow the pipe into it. Cells are h at the pipe, h * around in the
// mechanism and h * coarse far from it.
DefineConstant[
  diameter = {1,    Min 1e-6, Name "Parameters/diameter"}, // of the pipe [m]
  extent   = {5,    Min 1.5,  Name "Parameters/extent"},   // half the height of the section, and its width, in diameter
  h        = {0.05, Min 1e-6, Name "Parameters/h"},        // size of the cells at the pipe [m]
  around   = {2,    Min 1,    Name "Parameters/around"},   // size in the mechanism, in h
  coarse   = {16,   Min 1,    Name "Parameters/coarse"}    // size far from it, in h
];
r = diameter / 2;
b = extent * diameter;
Point(1) = {0, 0, 0};
Point(2) = {0, -r, 0};
Point(3) = {r, 0, 0};
Point(4) = {0, r, 0};
Point(5) = {0, -b, 0};
Point(6) = {b, -b, 0};
Point(7) = {b, b, 0};
Point(8) = {0, b, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {2, 5};
Line(4) = {5, 6};
Line(5) = {6, 7};
Line(6) = {7, 8};
Line(7) = {8, 4};
Line(8) = {4, 2};
Curve Loop(1) = {3, 4, 5, 6, 7, -2, -1};
Plane Surface(1) = {1};
Curve Loop(2) = {1, 2, 8};
Plane Surface(2) = {2};

Point(11) = {0, 0, 0};
Point(12) = {0, -r, 0};
Point(13) = {r, 0, 0};
Point(14) = {0, r, 0};
Circle(11) = {12, 11, 13};
Circle(12) = {13, 11, 14};
Line(13) = {14, 12};
Curve Loop(3) = {11, 12, 13};
Plane Surface(3) = {3};

Field[1] = Distance;
Field[1].CurvesList = {1, 2};
Field[1].Sampling = Ceil(4 * diameter / h);
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = h;
Field[2].SizeMax = coarse * h;
Field[2].DistMin = 2 * h;
Field[2].DistMax = 2 * h + 5 * (coarse - 1) * h;
Field[3] = Ball;
Field[3].VIn = around * h;
Field[3].VOut = coarse * h;
Field[3].Radius = 1.5 * diameter;
Field[3].Thickness = 5 * (coarse - around + 0.1) * h;
Field[4] = Min;
Field[4].FieldsList = {2, 3};
Background Field = 4;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("soil") = {1};
Physical Surface("hole") = {2};
Physical Surface("pipe") = {3};
Physical Curve("axis") = {3, 7, 8};
Physical Curve("rim") = {4, 5, 6};
Physical Curve("core") = {13};

// A layer of soil on a tight base: a strip of it between smooth walls.
//
//   +-----+ height + air
//   | air |
//   +-----+ height               regions  soil, top, air
//   |     |                      curves   bottom, walls
//   |soil |  walls               points   base
//   |     |
//   +-----+ 0
//   bottom
//
// `air` are empty cells, so that the surface of the soil is free: it is loaded there, and drains there. `top` is the uppermost row
// of cells of the soil, whose settlement case.yaml writes down.
// Gmsh shows all this, and its numbers may be changed there: gmsh consolidation.geo
DefineConstant[
  height = {2,    Min 1e-6, Name "Parameters/height"},  // of the layer, H: the length of the drainage path [m]
  width  = {0.4,  Min 1e-6, Name "Parameters/width"},   // of the strip [m]
  air    = {0.2,  Min 1e-6, Name "Parameters/air"},     // height of the room above the soil [m]
  h      = {0.05, Min 1e-6, Name "Parameters/h"},       // size of the cells at the surface [m]
  coarse = {4,    Min 1,    Name "Parameters/coarse"}   // size at the base, in h
];
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, height - h, 0};
Point(4) = {0, height - h, 0};
Point(5) = {width, height, 0};
Point(6) = {0, height, 0};
Point(7) = {width, height + air, 0};
Point(8) = {0, height + air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Line(8) = {5, 7};
Line(9) = {7, 8};
Line(10) = {8, 6};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10};
Plane Surface(3) = {3};

// Sizes of cells: they grow from h at the surface, where the pressure falls at once, to h * coarse at the base.
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (1 + %g * (%g - y) / %g)", h, coarse - 1, height, height);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("soil") = {1};
Physical Surface("top") = {2};
Physical Surface("air") = {3};
Physical Curve("bottom") = {1};
Physical Curve("walls") = {2, 4, 5, 7, 8, 10};
Physical Point("base") = {1};

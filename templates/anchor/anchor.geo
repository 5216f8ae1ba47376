// Half of a horizontal plate in clay, to the right of its axis. In plane strain it is a strip, in axisymmetry it is round.
//
//  |        air          |
//  +---------------------+ 0               regions  clay, hole, air, plate
//  |                     |                 curves   axis, side, bottom
//  |                     |
//  +------+  plate       | -cover
//  +------+              |
//  | axis       clay     | side
//  +---------------------+ -cover - beneath
//           bottom
//
// The plate has a mesh of its own, which lies over the hole. Hole and air are empty cells: clay may follow the plate into the hole
// and heave into the air. Gmsh shows all this, and its numbers may be changed there: gmsh anchor.geo
DefineConstant[
  half_width = {0.5,  Min 1e-6, Name "Parameters/half_width"}, // B/2, or the radius [m]
  thickness  = {0.2,  Min 1e-6, Name "Parameters/thickness"},  // of the plate [m]
  edge       = {0.05, Min 1e-6, Name "Parameters/edge"},       // radius of its edges [m]
  cover      = {4,    Min 1e-6, Name "Parameters/cover"},      // clay above the plate, H [m]
  beneath    = {3,    Min 1e-6, Name "Parameters/beneath"},    // clay beneath the top of the plate [m]
  width      = {7,    Min 1e-6, Name "Parameters/width"},      // of the clay from the axis on [m]
  air        = {1,    Min 1e-6, Name "Parameters/air"},        // height of the room above the clay [m]
  way        = {0.3,  Min 0,    Name "Parameters/way"},        // how far the plate goes upwards: the cells are fine so far [m]
  h          = {0.1,  Min 1e-6, Name "Parameters/h"},          // size of the cells around the plate [m]
  coarse     = {4,    Min 1,    Name "Parameters/coarse"}      // largest size, in h
];
depth = cover + beneath;
base = -cover - thickness;
// Edges that a thin plate has room for.
r = edge;
If (r > 0.3 * thickness)
  r = 0.3 * thickness;
EndIf
If (r > 0.3 * half_width)
  r = 0.3 * half_width;
EndIf

// The outline of the plate, twice: as the edge of the clay, with the points and curves 20 to 29, and as that of the plate itself, 40 to 49.
For k In {0:1}
  p = 20 + 20 * k;
  Point(p) = {0, -cover, 0};
  Point(p + 1) = {half_width - r, -cover, 0};
  Point(p + 2) = {half_width - r, -cover - r, 0};
  Point(p + 3) = {half_width, -cover - r, 0};
  Point(p + 4) = {half_width, base + r, 0};
  Point(p + 5) = {half_width - r, base + r, 0};
  Point(p + 6) = {half_width - r, base, 0};
  Point(p + 7) = {0, base, 0};
  Line(p) = {p, p + 1};
  Circle(p + 1) = {p + 1, p + 2, p + 3};
  Line(p + 2) = {p + 3, p + 4};
  Circle(p + 3) = {p + 4, p + 5, p + 6};
  Line(p + 4) = {p + 6, p + 7};
  Line(p + 5) = {p + 7, p};
EndFor

// Clay, and the air above it.
Point(1) = {0, -depth, 0};
Point(2) = {width, -depth, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Point(5) = {width, air, 0};
Point(6) = {0, air, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 20};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Line(8) = {27, 1};
Curve Loop(1) = {1, 2, 3, 4, 20, 21, 22, 23, 24, 8};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Curve Loop(3) = {20, 21, 22, 23, 24, 25};
Plane Surface(3) = {3};
Curve Loop(4) = {40, 41, 42, 43, 44, 45};
Plane Surface(4) = {4};

// Sizes of cells: h in a box around the plate and its way, growing outside of it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * half_width;
Field[1].YMin = base - half_width;
Field[1].YMax = -cover + half_width + way;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("clay") = {1};
Physical Surface("air") = {2};
Physical Surface("hole") = {3};
Physical Surface("plate") = {4};
Physical Curve("axis") = {4, 7, 8, 25};
Physical Curve("side") = {2, 5};
Physical Curve("bottom") = {1};

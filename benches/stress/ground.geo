// Half of a level ground with air above it, and half of a body with a mesh of its own that is pushed in or pulled out.
//
//   | | air        |                 regions  clay, air, body; lower if layer > 0, hole if buried
//   +-+------------+ 0               curves   axis, side, bottom
//   |body   clay   |
//   +--------------+ -layer
//   |       lower  | side
//   +--------------+ -depth
//        bottom
//
// Shapes of the body, of the radius or half width `radius`: 0 a circle, 1 flat below, 2 pointed, 3 a tube or sheets of
// the `thickness`, open below. Its lowest point is at 0, or it is `buried`: a circle or a plate of the `thickness` whose
// top is `cover` below the surface, which lies on the hole.
// Kinds of mesh: 0 unstructured (of the Gmsh algorithm 5, 6 or 8), 1 unstructured quadrangles and triangles (recombined),
// both of cells that grow to h * coarse away from the way of the body, 2 a regular lattice of right triangles, 3 of
// quadrangles (lengths are multiples of h).
DefineConstant[
  shape = 0, buried = 0, radius = 0.5, thickness = 0.2, angle = 60, way = 1, cover = 1,
  width = 2.5, depth = 2, air = 0.5, layer = 0, h = 0.25, coarse = 2, kind = 0, algorithm = 6
];
Mesh.Algorithm = algorithm;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
eps = 1e-6;
SetFactory("OpenCASCADE");
base = (shape == 0) ? -cover - 2 * radius : -cover - thickness;
If (kind < 2 || !buried)
  n = 2;
  Rectangle(1) = {0, -depth, 0, width, depth};
  Rectangle(2) = {0, 0, 0, width, air};
  If (layer > 0)
    n = 3;
    Rectangle(3) = {0, -depth, 0, width, depth - layer};
  EndIf
  If (buried && shape == 0)
    n = 3;
    Disk(3) = {0, base + radius, 0, radius};
    Rectangle(4) = {0, base, 0, radius, 2 * radius};
    BooleanIntersection(5) = { Surface{3}; Delete; }{ Surface{4}; Delete; };
    BooleanFragments{ Surface{1}; Delete; }{ Surface{2, 5}; Delete; }
  ElseIf (buried)
    Rectangle(3) = {0, base, 0, radius, thickness};
    BooleanFragments{ Surface{1}; Delete; }{ Surface{2, 3}; Delete; }
  Else
    BooleanFragments{ Surface{1}; Delete; }{ Surface{2:n}; Delete; }
  EndIf
Else
  // A plate in strips, so that all of them are lattices.
  xs() = {0, radius, width};
  ys() = {-depth, base, -cover, 0, air};
  For i In {0:1}
    For j In {0:3}
      Rectangle(1 + i + 2 * j) = {xs(i), ys(j), 0, xs(i + 1) - xs(i), ys(j + 1) - ys(j)};
    EndFor
  EndFor
  BooleanFragments{ Surface{1}; Delete; }{ Surface{2:8}; Delete; }
EndIf
top() = Surface In BoundingBox{-eps, -eps, -1, width + eps, air + eps, 1};
clay() = Surface In BoundingBox{-eps, -depth - eps, -1, width + eps, eps, 1};
If (layer > 0)
  lower() = Surface In BoundingBox{-eps, -depth - eps, -1, width + eps, -layer + eps, 1};
  clay() -= lower();
  Physical Surface("lower") = {lower()};
EndIf
If (buried)
  hole() = Surface In BoundingBox{-eps, base - eps, -1, radius + eps, -cover + eps, 1};
  clay() -= hole();
  Physical Surface("hole") = {hole()};
EndIf
Physical Surface("clay") = {clay()};
Physical Surface("air") = {top()};
Physical Curve("axis") = Curve In BoundingBox{-eps, -depth - eps, -1, eps, air + eps, 1};
Physical Curve("side") = Curve In BoundingBox{width - eps, -depth - eps, -1, width + eps, air + eps, 1};
Physical Curve("bottom") = Curve In BoundingBox{-eps, -depth - eps, -1, width + eps, -depth + eps, 1};
If (kind >= 2)
  curves() = Curve{:};
  For i In {0:#curves() - 1}
    b() = BoundingBox Curve{curves(i)};
    Transfinite Curve{curves(i)} = Round((b(3) - b(0) + b(4) - b(1)) / h) + 1;
  EndFor
  Transfinite Surface{:};
EndIf
If (kind == 1 || kind == 3)
  Recombine Surface{:};
EndIf

// The body, which shares no curve with the ground.
p = newp;
l = newl;
s = news;
bottom = buried ? base : 0;
height = buried ? thickness : way + air;
If (shape == 0)
  Point(p) = {0, bottom, 0};
  Point(p + 1) = {radius, bottom + radius, 0};
  Point(p + 2) = {0, bottom + 2 * radius, 0};
  Point(p + 3) = {0, bottom + radius, 0};
  Circle(l) = {p, p + 3, p + 1};
  Circle(l + 1) = {p + 1, p + 3, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Line(l + 3) = {p + 3, p};
Else
  inner = (shape == 3) ? radius - thickness : 0;
  Point(p) = {inner, bottom, 0};
  Point(p + 1) = {radius, (shape == 2) ? bottom + radius / Tan(angle * Pi / 360) : bottom, 0};
  Point(p + 2) = {radius, bottom + height + ((shape == 2) ? radius / Tan(angle * Pi / 360) : 0), 0};
  Point(p + 3) = {inner, bottom + height + ((shape == 2) ? radius / Tan(angle * Pi / 360) : 0), 0};
  Line(l) = {p, p + 1};
  Line(l + 1) = {p + 1, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Line(l + 3) = {p + 3, p};
EndIf
Curve Loop(s) = {l, l + 1, l + 2, l + 3};
Plane Surface(s) = {s};
If (kind == 1)
  Recombine Surface{s};
EndIf
Physical Surface("body") = {s};

// Sizes: h around the way of the body.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -1;
Field[1].XMax = 2 * radius;
Field[1].YMin = buried ? base - radius : -way - radius;
Field[1].YMax = buried ? -cover + radius + way : way + depth + air;
Field[1].Thickness = 3 * coarse * h;
Background Field = 1;

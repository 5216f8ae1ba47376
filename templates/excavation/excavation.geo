// An anchored wall in sand, on whose left a pit is dug in three stages.
//
//       air
//   +---------++--------------------+ 0
//   |  lift1  ||<-- anchor          |           regions  sand, lift1, lift2, lift3, air
//   +---------+|                    | -dig1     curves   sides, bottom
//   |  lift2  ||                    |
//   +---------+|       sand         | -dig2     The strip of width t is the place of the wall: mpm makes the wall itself, from
//   |  lift3  ||                    |           `plate` in case.yaml, and leaves the cells of sand in its place empty.
//   +---------+|                    | -dig3
//   |         ||                    |
//   |  sand   ++ -wall              | sides
//   +-------------------------------+ -depth
//    -left    x = 0   bottom     right
//
// Gmsh shows all this, and its numbers may be changed there: gmsh excavation.geo
SetFactory("OpenCASCADE");
DefineConstant[
  t      = {0.5,   Min 1e-6, Name "Parameters/t"},      // thickness of the wall, √(12 EI/EA) of case.yaml [m]
  wall   = {7.5,   Min 1e-6, Name "Parameters/wall"},   // its length: the end of `axis` in case.yaml [m]
  dig1   = {1.5,   Min 1e-6, Name "Parameters/dig1"},   // depths of the pit in its three stages [m]
  dig2   = {3.5,   Min 1e-6, Name "Parameters/dig2"},
  dig3   = {5,     Min 1e-6, Name "Parameters/dig3"},
  left   = {8,     Min 1e-6, Name "Parameters/left"},   // half of the width of the pit [m]
  right  = {14,    Min 1e-6, Name "Parameters/right"},  // sand behind the wall [m]
  depth  = {11,    Min 1e-6, Name "Parameters/depth"},  // of the sand [m]
  air    = {0.5,   Min 1e-6, Name "Parameters/air"},    // height of the room above the sand [m]
  h      = {0.25,  Min 1e-6, Name "Parameters/h"},      // size of the cells at the wall: at most t/2 [m]
  coarse = {4,     Min 1,    Name "Parameters/coarse"}  // largest size, in h
];
Rectangle(1) = {-left, -depth, 0, left + right, depth};   // sand
Rectangle(2) = {-left, 0, 0, left + right, air};
Rectangle(3) = {-left, -dig1, 0, left - t/2, dig1};
Rectangle(4) = {-left, -dig2, 0, left - t/2, dig2 - dig1};
Rectangle(5) = {-left, -dig3, 0, left - t/2, dig3 - dig2};
Rectangle(6) = {-t/2, -wall, 0, t, wall};                 // place of the wall
Coherence;
e = 1e-3;
air() = Surface In BoundingBox {-left - e, -e, -e, right + e, air + e, e};
lift1() = Surface In BoundingBox {-left - e, -dig1 - e, -e, -t/2 + e, e, e};
lift2() = Surface In BoundingBox {-left - e, -dig2 - e, -e, -t/2 + e, -dig1 + e, e};
lift3() = Surface In BoundingBox {-left - e, -dig3 - e, -e, -t/2 + e, -dig2 + e, e};
sand() = Surface In BoundingBox {-left - e, -depth - e, -e, right + e, e, e};
sand() -= {lift1(), lift2(), lift3()};

// Sizes of cells: h in a box around the wall, growing outside of it.
Field[1] = Box;
Field[1].VIn = h;
Field[1].VOut = coarse * h;
Field[1].XMin = -t;
Field[1].XMax = t;
Field[1].YMin = -wall - t;
Field[1].YMax = air;
Field[1].Thickness = 5 * coarse * h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

// What case.yaml calls them.
Physical Surface("sand") = {sand()};
Physical Surface("lift1") = {lift1()};
Physical Surface("lift2") = {lift2()};
Physical Surface("lift3") = {lift3()};
Physical Surface("air") = {air()};
Physical Curve("bottom") = Curve In BoundingBox {-left - e, -depth - e, -e, right + e, -depth + e, e};
Physical Curve("sides") = {
  Curve In BoundingBox {-left - e, -depth - e, -e, -left + e, air + e, e},
  Curve In BoundingBox {right - e, -depth - e, -e, right + e, air + e, e}
};

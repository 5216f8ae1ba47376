// A box of 2 m by 1.5 m with an opening in its floor, a block of 0.4 m above that, a bed of soil beside it, and a feed at the top.
SetFactory("OpenCASCADE");
DefineConstant[
  h    = {0.1, Name "Parameters/h"},   // size of the cells [m]
  y    = {0.4, Name "Parameters/y"},   // of the lower side of the block [m]
  quad = {0,   Name "Parameters/quad"} // 1: quadrilaterals
];
Mesh.MeshSizeMax = h;
Rectangle(1) = {0, 0, 0, 0.2, 1.5};
Rectangle(2) = {0.2, 0, 0, 0.8, 1.5};
Rectangle(3) = {1, 0, 0, 1, 1.5};
Rectangle(4) = {0.4, y, 0, 0.4, 0.4};
Rectangle(5) = {1.4, 0, 0, 0.4, 0.2};
Rectangle(6) = {0.4, 1.4, 0, 0.4, 0.1};
BooleanFragments{ Surface{1, 2, 3}; Delete; }{ Surface{4, 5, 6}; Delete; }
block() = Surface In BoundingBox{0.39, y - 0.01, -1, 0.81, y + 0.41, 1};
bed() = Surface In BoundingBox{1.39, -0.01, -1, 1.81, 0.21, 1};
feed() = Surface In BoundingBox{0.39, 1.39, -1, 0.81, 1.51, 1};
air() = Surface{:};
air() -= block();
air() -= bed();
air() -= feed();
If (quad)
  Mesh.RecombineAll = 1;
  Mesh.Algorithm = 8;
EndIf
Physical Surface("block") = block();
Physical Surface("bed") = bed();
Physical Surface("feed") = feed();
Physical Surface("air") = air();
Physical Curve("left") = Curve In BoundingBox{-0.01, -1, -1, 0.01, 2, 1};
Physical Curve("right") = Curve In BoundingBox{1.99, -1, -1, 2.01, 2, 1};
spout() = Curve In BoundingBox{0.19, -0.01, -1, 1.01, 0.01, 1};
floor() = Curve In BoundingBox{-0.01, -0.01, -1, 2.01, 0.01, 1};
floor() -= spout();
Physical Curve("spout") = spout();
Physical Curve("floor") = floor();
Physical Curve("inside") = Curve In BoundingBox{0.39, y - 0.01, -1, 0.81, y + 0.01, 1};
Physical Curve("inlet") = Curve In BoundingBox{0.39, 1.49, -1, 0.81, 1.51, 1};

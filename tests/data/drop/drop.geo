// A block of 0.4 m in the air of a box of 2 m by 1.5 m, or higher; beneath it a bed, or none (bed = 0).
SetFactory("OpenCASCADE");
DefineConstant[
  h    = {0.1,  Name "Parameters/h"},     // size of the cells [m]
  y    = {0.55, Name "Parameters/y"},     // of the lower side of the block [m]
  top  = {1.5,  Name "Parameters/top"},   // height of the box [m]
  bed  = {0,    Name "Parameters/bed"},   // its depth [m]
  quad = {0,    Name "Parameters/quad"}   // 1: quadrilaterals
];
Mesh.MeshSizeMax = h;
Rectangle(1) = {0, 0, 0, 2, top};
Rectangle(2) = {0.2, y, 0, 0.4, 0.4};
If (bed > 0)
  Rectangle(3) = {0, 0, 0, 2, bed};
  BooleanFragments{ Surface{1}; Delete; }{ Surface{2, 3}; Delete; }
  Physical Surface("bed") = {3};
  Physical Surface("air") = {4};
Else
  BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
  Physical Surface("air") = {3};
EndIf
If (quad)
  Mesh.RecombineAll = 1;
  Mesh.Algorithm = 8;
EndIf
Physical Surface("block") = {2};
Physical Curve("floor") = Curve In BoundingBox{-1, -0.01, -1, 3, 0.01, 1};
Physical Curve("left") = Curve In BoundingBox{-0.01, -1, -1, 0.01, top + 1, 1};
Physical Curve("right") = Curve In BoundingBox{1.99, -1, -1, 2.01, top + 1, 1};

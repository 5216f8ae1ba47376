// A cylinder, one metre in radius and height, in a box of room.
DefineConstant[ h = 0.13 ];
SetFactory("OpenCASCADE");
Mesh.Algorithm = 6;
Mesh.MeshSizeMax = h;
Mesh.MeshSizeMin = h;
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {0, 0, 0, 2, 1.5};
BooleanFragments{ Surface{2}; Delete; }{ Surface{1}; Delete; }
body() = Surface In BoundingBox{-0.001, -0.001, -1, 1.001, 1.001, 1};
room() = Surface{:};
room() -= body();
Physical Surface("body") = {body()};
Physical Surface("room") = {room()};
Physical Curve("lower") = Curve In BoundingBox{-1, -0.001, -1, 3, 0.001, 1};
Physical Curve("sides") = {Curve In BoundingBox{-0.001, -1, -1, 0.001, 3, 1}, Curve In BoundingBox{1.999, -1, -1, 2.001, 3, 1}};

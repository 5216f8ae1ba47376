// A block of soil, one metre wide and high, with room to fall to its right.
SetFactory("OpenCASCADE");
Mesh.Algorithm = 8;
Mesh.MeshSizeMax = 0.3224;
Mesh.MeshSizeMin = 0.3224;
Rectangle(1) = {0, 0, 0, 1, 1};
Rectangle(2) = {0, 0, 0, 2.5, 1.4};
BooleanFragments{ Surface{2}; Delete; }{ Surface{1}; Delete; }
body() = Surface In BoundingBox{-0.001, -0.001, -1, 1.001, 1.001, 1};
room() = Surface{:};
room() -= body();
Recombine Surface{:};
Physical Surface("body") = {body()};
Physical Surface("room") = {room()};
Physical Curve("lower") = Curve In BoundingBox{-1, -0.001, -1, 3, 0.001, 1};
Physical Curve("sides") = {Curve In BoundingBox{-0.001, -1, -1, 0.001, 3, 1}, Curve In BoundingBox{2.499, -1, -1, 2.501, 3, 1}};

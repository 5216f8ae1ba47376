// A beam 4 m long and 0.5 m deep.
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.25;
Rectangle(1) = {0, 0, 0, 4, 0.5};
Physical Surface("beam") = {1};
Physical Curve("tip") = {2};
Physical Curve("upper") = {3};
Physical Curve("clamp") = {4};

// Empty cells: the beam has elements of its own.
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 10;
Rectangle(1) = {0, -5, 0, 10, 10};
Physical Surface("air") = {1};

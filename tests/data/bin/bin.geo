// Half a bin, 0.5 m wide and filled one metre high, with air above.
SetFactory("OpenCASCADE");
Mesh.MeshSizeMax = 0.1;
Rectangle(1) = {0, 0, 0, 0.5, 1};
Rectangle(2) = {0, 1, 0, 0.5, 0.2};
Coherence;
Physical Surface("sand") = {1};
Physical Surface("air") = {2};
Physical Curve("floor") = Curve In BoundingBox{-1, -0.01, -1, 2, 0.01, 1};
Physical Curve("axis") = Curve In BoundingBox{-0.01, -1, -1, 0.01, 3, 1};
Physical Curve("bin") = Curve In BoundingBox{0.49, -1, -1, 0.51, 3, 1};

// Ground 12 m wide and 8 m deep with a wall 0.5 m thick and 6 m deep; on its left 3 m are dug in two lifts.
SetFactory("OpenCASCADE");
DefineConstant[ h = {0.25, Min 0.1, Name "Parameters/h"} ];
t = 0.5;  x = 4;  w = 12;
Rectangle(1) = {0, -8, 0, w, 8};  Rectangle(2) = {0, 0, 0, w, 1};
Rectangle(3) = {0, -1.5, 0, x - t/2, 1.5};  Rectangle(4) = {0, -3, 0, x - t/2, 1.5};  Rectangle(5) = {x - t/2, -6, 0, t, 6};
Coherence;
air() = Surface In BoundingBox {-0.1, -0.1, -1, w + 0.1, 1.1, 1};
lift1() = Surface In BoundingBox {-0.1, -1.6, -1, x - t/2 + 0.1, 0.1, 1};
lift2() = Surface In BoundingBox {-0.1, -3.1, -1, x - t/2 + 0.1, -1.4, 1};
soil() = Surface In BoundingBox {-0.1, -8.1, -1, w + 0.1, 0.1, 1};
soil() -= {lift1(), lift2()};
place() = Surface In BoundingBox {x - t/2 - 0.1, -6.1, -1, x + t/2 + 0.1, 0.1, 1};
Physical Surface("soil") = {soil()};  Physical Surface("lift1") = {lift1()};  Physical Surface("lift2") = {lift2()};  Physical Surface("air") = {air()};
Physical Curve("bottom") = Curve In BoundingBox {-0.1, -8.1, -1, w + 0.1, -7.9, 1};
Physical Curve("sides") = {Curve In BoundingBox {-0.1, -9, -1, 0.1, 2, 1}, Curve In BoundingBox {w - 0.1, -9, -1, w + 0.1, 2, 1}};
MeshSize{ PointsOf{ Surface{:}; } } = 4*h;
MeshSize{ PointsOf{ Surface{place()}; } } = h;

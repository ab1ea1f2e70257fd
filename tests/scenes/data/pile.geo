// A box of 20 mm x 12 mm with a sheet pile 0.6 mm thick that ends 4 mm above its floor: gmsh -2 -format msh41 pile.geo -o pile.msh
h = 0.0006;
Point(1) = {0, 0, 0, h}; Point(2) = {0.02, 0, 0, h}; Point(3) = {0.02, 0.012, 0, 2*h}; Point(4) = {0.0103, 0.012, 0, 2*h};
Point(5) = {0.0103, 0.004, 0, h/2}; Point(6) = {0.0097, 0.004, 0, h/2}; Point(7) = {0.0097, 0.012, 0, 2*h}; Point(8) = {0, 0.012, 0, 2*h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 1};
Curve Loop(1) = {1 ... 8}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top_right") = {3}; Physical Curve("pile") = {4, 5, 6};
Physical Curve("top_left") = {7}; Physical Curve("left") = {8}; Physical Surface("soil") = {1};

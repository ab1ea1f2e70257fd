// Mesh of piping-under-sheet-pile.prm: a box with a sheet pile that comes down from its top, lengths in m.
//   gmsh -2 -format msh41 sheet-pile.geo -o sheet-pile.msh
W = 0.02; H = 0.011; pile = 0.0006; tip = 0.0035; h = 0.0008; // tip: its lower end above the floor
left = 0.5 * (W - pile); right = 0.5 * (W + pile);
Point(1) = {0, 0, 0, h}; Point(2) = {W, 0, 0, h}; Point(3) = {W, H, 0, 1.5 * h}; Point(4) = {right, H, 0, h};
Point(5) = {right, tip, 0, h / 3}; Point(6) = {left, tip, 0, h / 3}; Point(7) = {left, H, 0, h}; Point(8) = {0, H, 0, 1.5 * h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 1};
Curve Loop(1) = {1 ... 8}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("downstream") = {3}; Physical Curve("pile") = {4, 5, 6};
Physical Curve("upstream") = {7}; Physical Curve("left") = {8}; Physical Surface("soil") = {1};
Mesh.RandomSeed = 1;

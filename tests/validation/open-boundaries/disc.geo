// A disc of 2 mm in a channel of 40 mm by 16 mm, for vortex-street.prm.
//   gmsh -2 -format msh41 disc.geo -o disc.msh
D = 2e-3;
Point(1) = {0, 0, 0}; Point(2) = {20 * D, 0, 0}; Point(3) = {20 * D, 8 * D, 0}; Point(4) = {0, 8 * D, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Point(10) = {5 * D, 4 * D, 0};
For i In {0:3}
  Point(11 + i) = {5 * D + D / 2 * Cos(i * Pi / 2), 4 * D + D / 2 * Sin(i * Pi / 2), 0};
EndFor
Circle(11) = {11, 10, 12}; Circle(12) = {12, 10, 13}; Circle(13) = {13, 10, 14}; Circle(14) = {14, 10, 11};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(1) = {1, 2};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Curve("disc") = {11, 12, 13, 14};
Physical Surface("domain") = {1};
Field[1] = MathEval;
Field[1].F = Sprintf("Max(%g, 0.25 * (Sqrt((x - %g)^2 + (y - %g)^2) - %g))", D / 2.5, 5 * D, 4 * D, D / 2);
Field[2] = MathEval;
Field[2].F = Sprintf("%g", 1.6 * D);
Field[3] = Min; Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeFromCurvature = 0;
Mesh.RandomSeed = 1;
Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.SubdivisionAlgorithm = 1;

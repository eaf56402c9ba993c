// A crash box: a square tube of quadrilaterals, 60 x 60 x 150 mm with round edges.
//   gmsh crash_box.geo -3 -format msh41 -o crash_box.msh
a = 30; r = 6; h = 150; size = 10;
Point(1) = {a - r, -a, 0}; Point(2) = {a - r, -a + r, 0}; Point(3) = {a, -a + r, 0};
Point(4) = {a, a - r, 0}; Point(5) = {a - r, a - r, 0}; Point(6) = {a - r, a, 0};
Point(7) = {-a + r, a, 0}; Point(8) = {-a + r, a - r, 0}; Point(9) = {-a, a - r, 0};
Point(10) = {-a, -a + r, 0}; Point(11) = {-a + r, -a + r, 0}; Point(12) = {-a + r, -a, 0};
Circle(1) = {1, 2, 3}; Line(2) = {3, 4}; Circle(3) = {4, 5, 6}; Line(4) = {6, 7};
Circle(5) = {7, 8, 9}; Line(6) = {9, 10}; Circle(7) = {10, 11, 12}; Line(8) = {12, 1};
Transfinite Curve{1, 3, 5, 7} = 3;
Transfinite Curve{2, 4, 6, 8} = 6;
wall[] = {}; foot[] = {}; head[] = {};
For i In {1:8}
  side[] = Extrude {0, 0, h} { Curve{i}; Layers{15}; Recombine; };
  wall[] += side[1]; foot[] += i; head[] += side[0];
EndFor
Physical Surface("wall") = wall[];
Physical Curve("foot") = foot[];
Physical Curve("head") = head[];

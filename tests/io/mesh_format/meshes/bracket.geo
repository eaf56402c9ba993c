// An angle bracket, 40 x 30 x 40 mm and 5 mm thick, of hexahedra; the fillet in its corner is of wedges.
//   gmsh bracket.geo -3 -format msh41 -o bracket.msh
Point(1) = {0, 0, 0}; Point(2) = {5, 0, 0}; Point(3) = {15, 0, 0}; Point(4) = {40, 0, 0};
Point(5) = {0, 0, 5}; Point(6) = {5, 0, 5}; Point(7) = {15, 0, 5}; Point(8) = {40, 0, 5};
Point(9) = {0, 0, 15}; Point(10) = {5, 0, 15}; Point(11) = {0, 0, 40}; Point(12) = {5, 0, 40};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {5, 6}; Line(5) = {6, 7}; Line(6) = {7, 8};
Line(7) = {1, 5}; Line(8) = {2, 6}; Line(9) = {3, 7}; Line(10) = {4, 8};
Line(11) = {5, 9}; Line(12) = {6, 10}; Line(13) = {9, 11}; Line(14) = {10, 12};
Line(15) = {9, 10}; Line(16) = {11, 12}; Line(17) = {7, 10};
Curve Loop(1) = {1, 8, -4, -7}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 9, -5, -8}; Plane Surface(2) = {2};
Curve Loop(3) = {3, 10, -6, -9}; Plane Surface(3) = {3};
Curve Loop(4) = {4, 12, -15, -11}; Plane Surface(4) = {4};
Curve Loop(5) = {15, 14, -16, -13}; Plane Surface(5) = {5};
Curve Loop(6) = {5, 17, -12}; Plane Surface(6) = {6};
Transfinite Curve{1, 4, 15, 16, 7, 8, 9, 10} = 3;
Transfinite Curve{2, 5, 11, 12, 17} = 4;
Transfinite Curve{3, 6, 13, 14} = 6;
Transfinite Surface{1:6};
Recombine Surface{1:5};
all[] = {}; seat[] = {}; back[] = {};
For i In {1:6}
  grown[] = Extrude {0, 30, 0} { Surface{i}; Layers{6}; Recombine; };
  all[] += grown[1];
  If (i <= 3)
    seat[] += grown[2];
  EndIf
  If (i == 1 || i == 4 || i == 5)
    back[] += grown[5];
  EndIf
EndFor
Physical Volume("bracket") = all[];
Physical Surface("seat") = seat[];
Physical Surface("back") = back[];

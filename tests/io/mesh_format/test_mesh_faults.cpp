// What is wrong with a mesh file is named by file and line, and what to do instead.

#include <gtest/gtest.h>

#include <fstream>

#include "io/mesh_file/id_map.hpp"
#include "io/mesh_file/mesh_file_error.hpp"
#include "io/mesh_format/read_abaqus.hpp"
#include "io/mesh_format/read_exodus.hpp"
#include "io/mesh_format/read_gmsh.hpp"
#include "io/mesh_format/read_ls_dyna.hpp"
#include "io/mesh_format/read_mesh_file.hpp"
#include "tests/io/mesh_format/mesh_writers.hpp"
#include "tests/io/results/result_scene.hpp"

namespace brio::test {
namespace {

template <class Read>
std::string fault_of(const Read& read) {
  try {
    read();
  } catch (const MeshFileError& fault) {
    return fault.what();
  }
  return "no fault";
}

std::string fault_of_gmsh(const std::string& text) {
  return fault_of([&] { mesh_of(read_gmsh(text, "a.msh")); });
}
std::string fault_of_abaqus(const std::string& text) {
  return fault_of([&] { mesh_of(read_abaqus(text, "a.inp")); });
}
std::string fault_of_dyna(const std::string& text) {
  return fault_of([&] { mesh_of(read_ls_dyna(text, "a.k")); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// One hexahedron on a square, and its bottom.
const std::string cube_gmsh = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "bottom"
3 2 "cube"
$EndPhysicalNames
$Entities
0 0 1 1
1 0 0 0 1 1 0 1 1 0
1 0 0 0 1 1 1 1 2 0
$EndEntities
$Nodes
1 8 1 8
3 1 0 8
1
2
3
4
5
6
7
8
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
$EndNodes
$Elements
2 2 1 2
2 1 3 1
1 1 2 3 4
3 1 5 1
2 1 2 3 4 5 6 7 8
$EndElements
)";

const std::string cube_abaqus = R"(*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8R, ELSET=cube
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=bottom
1, 2, 3, 4
*SURFACE, NAME=under
cube, S1
)";

const std::string cube_dyna = R"(*KEYWORD
*NODE
       1             0.0             0.0             0.0
       2             1.0             0.0             0.0
       3             1.0             1.0             0.0
       4             0.0             1.0             0.0
       5             0.0             0.0             1.0
       6             1.0             0.0             1.0
       7             1.0             1.0             1.0
       8             0.0             1.0             1.0
*ELEMENT_SOLID
       1       7
       1       2       3       4       5       6       7       8
*SET_NODE_LIST
        12
         1         2         3         4
*END
)";

TEST(MeshFaults, NoneInTheMeshesThatAreChanged) {
  const Mesh gmsh = mesh_of(read_gmsh(cube_gmsh, "a.msh")),
             abaqus = mesh_of(read_abaqus(cube_abaqus, "a.inp")),
             dyna = mesh_of(read_ls_dyna(cube_dyna, "a.k"), "7");
  for (const Mesh* mesh : {&gmsh, &abaqus, &dyna}) {
    EXPECT_TRUE(mesh->position == gmsh.position);
    EXPECT_EQ(mesh->connectivity, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
  EXPECT_EQ(gmsh.node_sets.at("bottom"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(gmsh.side_sets.at("bottom")[0].side, 0);
  EXPECT_EQ(abaqus.side_sets.at("under")[0].side, 0);
  EXPECT_EQ(dyna.node_sets.at("node_set_12").size(), 4u);
  EXPECT_EQ(gmsh.side_sets.at("all").size(), 6u);
}

struct MeshFault {
  const char* from;
  const char* to;
  const char* message;
};

class GmshFaults : public testing::TestWithParam<MeshFault> {};
TEST_P(GmshFaults, AreNamedByLine) {
  const auto& [from, to, message] = GetParam();
  EXPECT_EQ(fault_of_gmsh(replaced(cube_gmsh, from, to)).substr(0, std::string(message).size()), message);
}
INSTANTIATE_TEST_SUITE_P(
    Texts, GmshFaults,
    testing::Values(
        MeshFault{"4.1 0 8", "2.2 0 8",
                  "a.msh:2: format 2.2; accepted is 4.1; save it with 'gmsh -save -format msh41'"},
        MeshFault{"4.1 0 8", "4.1 2 8", "a.msh:2: the type of the file is neither 0 (ASCII) nor 1 (binary)"},
        MeshFault{"4.1 0 8", "4.1 0 4", "a.msh:2: numbers of 4 bytes; accepted are 8"},
        MeshFault{"$MeshFormat", "$MeshFormt", "a.msh:1: '$MeshFormat' is expected at the beginning"},
        MeshFault{"1 8 1 8", "1 x 1 8", "a.msh:15: 'x' is not the number of nodes; an integer is expected"},
        MeshFault{"1 8 1 8", "1 80000000000 1 8",
                  "a.msh:15: 80000000000 nodes are announced, more than the file can hold"},
        MeshFault{"3 1 0 8", "3 1 0 1000000000",
                  "a.msh:16: 1000000000 nodes of a block are announced, more than the file can hold"},
        MeshFault{"1 8 1 8", "1 9 1 8", "a.msh:32: 9 nodes are announced, but there are 8"},
        MeshFault{"0 1 1\n$End", "0 1 nan\n$End", "a.msh:32: a coordinate of node 8 is not a finite number"},
        MeshFault{"0 1 1\n$End", "0 1 1e999\n$End",
                  "a.msh:32: '1e999' is not a coordinate; a number is expected"},
        MeshFault{"0 1 1\n$End", "0 1\n$End",
                  "a.msh:33: '$EndNodes' is not a coordinate; a number is expected"},
        MeshFault{"\n8\n0 0 0", "\n7\n0 0 0", "a.msh:32: node 7 stands twice; numbers are unique"},
        MeshFault{"2 1 2 3 4 5 6 7 8", "2 1 2 3 4 5 6 7 9",
                  "a.msh:39: element 2 names node 9, which the file does not have"},
        MeshFault{"2 1 2 3 4 5 6 7 8", "1 1 2 3 4 5 6 7 8",
                  "a.msh:39: element 1 stands twice; numbers are unique"},
        MeshFault{
            "2 1 2 3 4 5 6 7 8", "2 5 6 7 8 1 2 3 4",
            "a.msh:39: element 2 of block 'cube' is inverted or has no volume; accepted are nodes that go "
            "around"},
        MeshFault{"2 1 2 3 4 5 6 7 8", "2 1 2 3 4 1 2 3 4",
                  "a.msh:39: element 2 of block 'cube' has 4 different nodes; expected are at least 6"},
        MeshFault{
            "3 1 5 1\n2 1 2 3 4 5 6 7 8", "3 1 4 1\n2 1 2 3 5",
            "a.msh:39: block 'cube' has 1 tetrahedra with 4 nodes, which no part can be made of; hexahedra "
            "are"},
        MeshFault{
            "3 1 5 1\n2 1 2 3 4 5 6 7 8", "3 1 11 1\n2 1 2 3 5 4 6 7 8 1 2",
            "a.msh:39: block 'cube' has 1 tetrahedra with 10 nodes, which no part can be made of; elements "
            "of first"},
        MeshFault{"3 1 5 1\n2 1", "3 1 93 1\n2 1",
                  "a.msh:38: elements of type 93 are not known; accepted are hexahedra"},
        MeshFault{"$EndElements", "$EndElement",
                  "a.msh:40: '$EndElement' stands where '$EndElements' is expected"},
        MeshFault{"$EndElements\n", "", "a.msh:40: the file ends where the end of a section is expected"},
        MeshFault{"$Entities", "$PartitionedEntities",
                  "a.msh:9: the mesh is partitioned; accepted are meshes without"},
        MeshFault{"3 2 \"cube\"", "3 2 cube",
                  "a.msh:7: a name of a physical group is expected, in double quotes"}));

class AbaqusFaults : public testing::TestWithParam<MeshFault> {};
TEST_P(AbaqusFaults, AreNamedByLine) {
  const auto& [from, to, message] = GetParam();
  EXPECT_EQ(fault_of_abaqus(replaced(cube_abaqus, from, to)).substr(0, std::string(message).size()), message);
}
INSTANTIATE_TEST_SUITE_P(
    Texts, AbaqusFaults,
    testing::Values(
        MeshFault{"*NODE", "NODE", "a.inp:1: 'NODE' stands where a keyword is expected, such as *NODE"},
        MeshFault{"8, 0, 1, 1", "8, 0, 1, x", "a.inp:9: 'x' is not a coordinate; a number is expected"},
        MeshFault{"8, 0, 1, 1", "8, 0, 1, inf", "a.inp:9: a coordinate of node 8 is not a finite number"},
        MeshFault{"8, 0, 1, 1", "7, 0, 1, 1", "a.inp:9: node 7 stands twice; numbers are unique"},
        MeshFault{"1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7",
                  "a.inp:11: an element of type C3D8R has 8 numbers; expected are its number and 8 nodes"},
        MeshFault{"1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 80",
                  "a.inp:11: element 1 names node 80, which the file does not have"},
        MeshFault{"1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 4, 3, 2, 1, 8, 7, 6, 5",
                  "a.inp:11: element 1 of block 'cube' is inverted or has no volume"},
        MeshFault{"TYPE=C3D8R", "TYPE=C3D80",
                  "a.inp:10: elements of type C3D80 are not known; accepted are hexahedra"},
        MeshFault{"TYPE=C3D8R,", "", "a.inp:10: *ELEMENT has no TYPE; it is required"},
        MeshFault{"TYPE=C3D8R, ELSET=cube\n1, 1, 2, 3, 4, 5, 6, 7, 8", "TYPE=C3D4, ELSET=cube\n1, 1, 2, 3, 5",
                  "a.inp:11: block 'cube' has 1 tetrahedra with 4 nodes, which no part can be made of"},
        MeshFault{"1, 2, 3, 4\n*SURF", "1, 2, 3, 44\n*SURF",
                  "a.inp:12: set 'bottom' names node 44, which the file does"},
        MeshFault{"1, 2, 3, 4\n*SURF", "nothing\n*SURF", "a.inp:12: no set is named 'NOTHING'"},
        MeshFault{"1, 2, 3, 4\n*SURF", "bottom\n*SURF", "a.inp:12: set 'bottom' contains itself"},
        MeshFault{"cube, S1", "cub, S1", "a.inp:15: no set of elements is named 'CUB'"},
        MeshFault{"cube, S1", "cube, S9",
                  "a.inp:15: a side of surface 'under' is 'S9'; accepted are S1 to S6"},
        MeshFault{"cube, S1", "5, S1", "a.inp:15: set 'under' names element 5, which the file does not have"},
        MeshFault{"*SURFACE", "*ELGEN",
                  "a.inp:14: *ELGEN is not followed, and the mesh would lack what it makes"},
        MeshFault{"*NODE", "*NODE, SYSTEM=C",
                  "a.inp:1: coordinates in the system 'C'; accepted are rectangular ones"}));

class DynaFaults : public testing::TestWithParam<MeshFault> {};
TEST_P(DynaFaults, AreNamedByLine) {
  const auto& [from, to, message] = GetParam();
  EXPECT_EQ(fault_of_dyna(replaced(cube_dyna, from, to)).substr(0, std::string(message).size()), message);
}
INSTANTIATE_TEST_SUITE_P(
    Texts, DynaFaults,
    testing::Values(MeshFault{"       8             0.0", "       x             0.0",
                              "a.k:10: 'x' is not the number of a node; an integer is expected"},
                    MeshFault{"       8             0.0", "       7             0.0",
                              "a.k:10: node 7 stands twice; numbers are unique"},
                    MeshFault{"       8             0.0", "8 0.0 1.0 1.0",
                              "a.k:10: '8 0.0 1.' is not the number of a node"},
                    MeshFault{"6       7       8\n", "6       7       9\n",
                              "a.k:12: element 1 names node 9, which the file does not have"},
                    MeshFault{"       5       6       7       8\n", "       5       5       5       5\n",
                              "a.k:12: block '7' has 1 pyramids with 5 nodes, which no part can be made of; "
                              "hexahedra and wedges"},
                    MeshFault{"*ELEMENT_SOLID", "*ELEMENT_SOLID_ORTHO",
                              "a.k:11: *ELEMENT_SOLID_ORTHO is not read; accepted are"},
                    MeshFault{"*KEYWORD", "*KEYWORD LONG=Y",
                              "a.k:1: *KEYWORD LONG=Y asks for long columns; accepted are the standard"},
                    MeshFault{"*SET_NODE_LIST", "*INCLUDE",
                              "a.k:14: *INCLUDE is not followed, and the mesh would lack what it brings"},
                    MeshFault{"         4\n*END", "        44\n*END",
                              "a.k:16: set 'node_set_12' names node 44, which the file does not have"}));

TEST(MeshFaults, OfFilesAreNamed) {
  const Folder folder;
  const auto fault = [&](const char* name, MeshFormat format) {
    return fault_of([&] { read_mesh_file(folder / name, name, format); });
  };
  EXPECT_EQ(fault("none.msh", MeshFormat::gmsh), "none.msh: cannot be opened: No such file or directory");
  EXPECT_EQ(fault(".", MeshFormat::gmsh), ".: is not a regular file");
  std::ofstream(folder / "empty.msh") << "";
  EXPECT_EQ(fault("empty.msh", MeshFormat::gmsh),
            "empty.msh:1: the file is empty; a mesh of Gmsh is expected");
  std::ofstream(folder / "text.exo") << "no netCDF";
  EXPECT_EQ(fault("text.exo", MeshFormat::exodus).substr(0, 33), "text.exo: is not an Exodus file: ");
  EXPECT_EQ(fault("empty.msh", MeshFormat::abaqus), "empty.msh: the file has no nodes");
}

TEST(MeshFaults, ExodusNamesTheVariable) {
  const Folder folder;
  Mesh mesh = mesh_of(read_gmsh(cube_gmsh, "a.msh"));
  write_exodus(mesh, folder / "a.exo");
  EXPECT_EQ(fault_of([&] { mesh_of(read_exodus(folder / "a.exo", "a.exo")); }), "no fault");
  mesh.position[3][1] = std::numeric_limits<double>::infinity();
  write_exodus(mesh, folder / "b.exo");
  EXPECT_EQ(fault_of([&] { read_exodus(folder / "b.exo", "b.exo"); }),
            "b.exo: a coordinate of node 4 is not a finite number");
  mesh = mesh_of(read_gmsh(cube_gmsh, "a.msh"));
  mesh.node_id[1] = mesh.node_id[0];
  write_exodus(mesh, folder / "c.exo");
  EXPECT_EQ(fault_of([&] { read_exodus(folder / "c.exo", "c.exo"); }),
            "c.exo: node 1 stands twice; numbers are unique");
}

TEST(IdMap, FindsNumbersThatFollowEachOtherAndOthers) {
  const std::vector<std::int64_t> close{5, 7, 6, 10}, far{-9000000000000000000, 3, 9000000000000000000};
  const IdMap table(close), sorted(far);
  for (std::size_t i = 0; i < close.size(); ++i) EXPECT_EQ(table.find(close[i]), static_cast<int>(i));
  for (std::size_t i = 0; i < far.size(); ++i) EXPECT_EQ(sorted.find(far[i]), static_cast<int>(i));
  for (const std::int64_t id : {4L, 8L, 11L, -9000000000000000000L}) EXPECT_EQ(table.find(id), -1);
  EXPECT_EQ(sorted.find(4), -1);
  EXPECT_EQ(table.repeated(), -1);
  EXPECT_EQ(IdMap(std::vector<std::int64_t>{1, 2, 3, 2, 1}).repeated(), 3);
  EXPECT_EQ(IdMap(std::vector<std::int64_t>{1, 1000000, 3, 1000000}).repeated(), 3);
}

}  // namespace
}  // namespace brio::test

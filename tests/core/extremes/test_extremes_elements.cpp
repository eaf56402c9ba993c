// Elements of extreme shape, nearly incompressible ones, and broken ones: at the start and during the run.

#include <gtest/gtest.h>

#include <numbers>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "tests/core/extremes/extremes.hpp"

namespace brio {
namespace {

using namespace test;

// ---- shapes and moduli

/// Viscous forces of a jump in velocity are integrated to first order in the time step only.
void make_inviscid(Part& part) {
  std::visit(
      [](auto& element) {
        if constexpr (requires { element.linear_bulk_viscosity; }) element.linear_bulk_viscosity = 0;
        if constexpr (requires { element.quadratic_bulk_viscosity; }) element.quadratic_bulk_viscosity = 0;
      },
      part.element);
}

/// A body of elements that are a thousand times as long as thick, thrown at a block.
Part slender(Kind kind) {
  Part part = body(kind, "upper");
  if (auto* mesh = std::get_if<BoxMesh>(&part.mesh)) *mesh = {{0.4, 0.4, 0.0004}, {1, 1, 1}};
  if (auto* mesh = std::get_if<PlateMesh>(&part.mesh)) *mesh = {{0.4, 0.4}, {1, 1}};
  if (auto* shell = std::get_if<Shell4>(&part.element)) shell->thickness = 0.0004;
  if (auto* mesh = std::get_if<LineMesh>(&part.mesh)) mesh->elements = 1;
  if (auto* beam = std::get_if<Beam2>(&part.element)) beam->section = CircleSection{0.0004};
  return part;
}

TEST(ExtremesShape, AspectRatioOfAThousandBouncesOffAndIsBounced) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::hex8_full, Kind::shell, Kind::beam}) {
    SCOPED_TRACE(name_of_kind(kind));
    Deck deck = impact_of(slender(kind), body(Kind::hex8, "lower"), 0.0004);
    for (Part& part : deck.parts) make_inviscid(part);
    deck.initial_conditions[0].velocity = {0, 0, -5};
    deck.contact->options.friction = 0;
    deck.parts[1].placement.translate[2] -= 0.03;  // of 0.04 above the middle of the block, which is tilted
    deck.time.end = 3e-3;
    const Watched watched(deck, 500);
    std::printf("%s: %lld steps, error %.0e, added %.0e, overlap %.0e, missed %ld\n", name_of_kind(kind),
                static_cast<long long>(watched.model.step), watched.model.energy.error_max, watched.added(),
                watched.overlap(), watched.missed);
    EXPECT_GT(watched.touched(), 0);
    EXPECT_EQ(watched.missed, 0);
    EXPECT_LE(watched.worst_linear, 1e-12);
    EXPECT_LE(watched.model.energy.error_max, 5e-2);
    EXPECT_LE(watched.added(), 1e-3);
  }
}

// The volume of what is thrown at a wall stays, since its pressure is bounded by the impact.
TEST(ExtremesShape, NearlyIncompressibleRunsAndKeepsItsVolume) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::hex8_full, Kind::shell, Kind::beam, Kind::particles}) {
    SCOPED_TRACE(name_of_kind(kind));
    Deck deck;
    Elastic law = elastic(0.4999);
    deck.materials = {{"material", law}};
    deck.parts = {body(kind, "body")};
    deck.parts[0].placement.rotate = Rotation{{1, 0.4, 0.7}, 37};
    deck.initial_conditions = {moving("body", {0, 0, -10})};
    RigidWall wall;
    wall.point = {0, 0, -0.36};
    wall.normal = {0, 0, 1};
    deck.boundary_conditions = {wall};
    deck.time.end = kind == Kind::beam || kind == Kind::shell ? 0.05 : 0.02;
    Model model = build_model(deck);
    ThreadTeam team(1);
    run(model, deck, team);
    EXPECT_GT(mean_velocity(model, 0, 2), -9) << "it has met the wall";
    EXPECT_LE(model.energy.error_max, 1e-2);
    if (kind != Kind::hex8 && kind != Kind::hex8_full) continue;
    // Bulk modulus 1.7e12, and a pressure of no more than rho c v of 4e7 for a moment.
    for (std::size_t e = 0; e < model.blocks[0].element_count; ++e) {
      const ElementSample sample = model.blocks[0].kernel.sample(model.blocks[0], model.nodes, e, true);
      EXPECT_LT(std::abs(sample.stress.xx + sample.stress.yy + sample.stress.zz) / 3, 1e9);
    }
  }
}

// ---- broken at the start

Mesh mesh_of(Kind kind) {
  const Part part = body(kind, "body");
  return generate_mesh(part.mesh, part.placement);
}

std::string refusal(Kind kind, const Mesh& mesh) {
  Deck deck;
  deck.materials = {{"material", elastic(0.3)}};
  deck.parts = {body(kind, "body")};
  deck.time.end = 1;
  if (kind == Kind::rigid) deck.time.step = 1e-3;
  deck.contact.emplace();
  try {
    build(deck, {&mesh, 1});
  } catch (const BuildError& fault) {
    return fault.what();
  }
  return "";
}

int corner(const Mesh& mesh, int element, int k) {
  return mesh.connectivity[index(element * mesh.nodes_per_element + k)];
}
Vector3d& place(Mesh& mesh, int node) { return mesh.position[index(node)]; }

struct Damage {
  const char* name;
  void (*apply)(Mesh&);
};

/// Squashes element 5 to a plane.
void flatten(Mesh& mesh) {
  for (int k = 0; k < mesh.nodes_per_element / 2; ++k)
    place(mesh, corner(mesh, 5, k + mesh.nodes_per_element / 2)) = place(mesh, corner(mesh, 5, k));
}
void collapse(Mesh& mesh) {
  for (int k = 1; k < mesh.nodes_per_element; ++k)
    place(mesh, corner(mesh, 5, k)) = place(mesh, corner(mesh, 5, 0));
}
void invert(Mesh& mesh) {
  for (int k = 0; k < mesh.nodes_per_element / 2; ++k)
    std::swap(mesh.connectivity[index(5 * mesh.nodes_per_element + k)],
              mesh.connectivity[index(5 * mesh.nodes_per_element + k + mesh.nodes_per_element / 2)]);
}
constexpr std::array damages{Damage{"flat", flatten}, Damage{"collapsed", collapse},
                             Damage{"inverted", invert}};

TEST(ExtremesBrokenAtTheStart, SolidsAreRefusedByName) {
  const FloatingPointTraps traps;
  for (const Kind kind : {Kind::hex8, Kind::hex8_full, Kind::rigid})
    for (const Damage& damage : damages) {
      Mesh mesh = mesh_of(kind);
      damage.apply(mesh);
      const std::string text = refusal(kind, mesh);
      std::printf("%s %s: %s\n", name_of_kind(kind), damage.name, text.c_str());
      EXPECT_NE(text.find("part 'body'"), std::string::npos)
          << name_of_kind(kind) << ' ' << damage.name << text;
      EXPECT_NE(text.find("element 5 "), std::string::npos)
          << name_of_kind(kind) << ' ' << damage.name << text;
    }
}

TEST(ExtremesBrokenAtTheStart, ShellsAreRefusedByName) {
  const FloatingPointTraps traps;
  for (const Damage& damage :
       {Damage{"collapsed", collapse},
        Damage{"bow tie", [](Mesh& mesh) { std::swap(mesh.connectivity[20], mesh.connectivity[21]); }},
        Damage{"all in a line",
               [](Mesh& mesh) {
                 const Vector3d a = place(mesh, corner(mesh, 5, 0));
                 for (int k = 1; k < 4; ++k) place(mesh, corner(mesh, 5, k)) = {a[0] + 0.03 * k, a[1], a[2]};
               }},
        Damage{"concave", [](Mesh& mesh) {
                 Vector3d& x = place(mesh, corner(mesh, 5, 2));
                 const Vector3d& a = place(mesh, corner(mesh, 5, 0));
                 x = {a[0] + 0.01, a[1] + 0.01, 0};
               }}}) {
    Mesh mesh = mesh_of(Kind::shell);
    damage.apply(mesh);
    const std::string text = refusal(Kind::shell, mesh);
    std::printf("shell4 %s: %s\n", damage.name, text.c_str());
    EXPECT_NE(text.find("element 5 of part 'body'"), std::string::npos) << damage.name << text;
  }
}

TEST(ExtremesBrokenAtTheStart, BeamsWithoutLengthAreRefusedByName) {
  const FloatingPointTraps traps;
  Mesh mesh = mesh_of(Kind::beam);
  place(mesh, corner(mesh, 2, 1)) = place(mesh, corner(mesh, 2, 0));
  const std::string text = refusal(Kind::beam, mesh);
  std::printf("beam2: %s\n", text.c_str());
  EXPECT_NE(text.find("element 2 of part 'body'"), std::string::npos) << text;
}

TEST(ExtremesBrokenAtTheStart, PositionsThatAreNotNumbersAreRefused) {
  for (const Kind kind : all_kinds)
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
      Mesh mesh = mesh_of(kind);
      mesh.position[2][1] = wrong;
      const std::string text = refusal(kind, mesh);
      EXPECT_NE(text.find("part 'body'"), std::string::npos) << name_of_kind(kind) << ' ' << wrong << text;
    }
}

// ---- broken during the run

/// One side of a body is driven through the other.
Deck crushed(Kind kind, bool deletes) {
  Deck deck;
  deck.materials = {{"material", elastic()}};
  deck.parts = {body(kind, "body")};
  const bool is_line = kind == Kind::beam;
  PrescribedMotion driven;
  driven.where.set = is_line ? "body.end" : "body.xmax";
  driven.components.push_back({0, Curve{{{0, -100}}}});
  deck.boundary_conditions = {driven, fix("body.all", {1, 2}),
                              fix(is_line ? "body.start" : "body.xmin", {0})};
  if (deletes) {
    deck.parts[0].deletion.emplace().inverted = true;
    deck.parts[0].deletion->minimum_step = 1e-7;
  }
  deck.numerics.energy_error_limit = 1e3;
  deck.time.end = 8e-3;
  return deck;
}

TEST(ExtremesBrokenInTheRun, StopsNamingTheElementOrDeletesItAndGoesOn) {
  const FloatingPointTraps traps;
  for (const Kind kind : deformable_kinds) {
    SCOPED_TRACE(name_of_kind(kind));
    const Deck deck = crushed(kind, false);
    Model model = build_model(deck);
    ThreadTeam team(1);
    try {
      run(model, deck, team);
      ADD_FAILURE() << "ran";
    } catch (const Breakdown& breakdown) {
      const std::string text = breakdown.what();
      std::printf("%s: %s\n", name_of_kind(kind), text.c_str());
      EXPECT_NE(text.find("of part 'body'"), std::string::npos) << text;
    }
    const Deck deleting = crushed(kind, true);
    Model goes_on = build_model(deleting);
    run(goes_on, deleting, team);
    EXPECT_GT(goes_on.erosion->total_deleted(), 0);
    EXPECT_TRUE(std::isfinite(goes_on.energy.sum()));
  }
}

// ---- warped shells

TEST(ExtremesShape, StronglyWarpedShellsRunAndBalanceEnergy) {
  const FloatingPointTraps traps;
  for (const bool projection : {false, true}) {
    SCOPED_TRACE(projection);
    Deck deck;
    deck.materials = {{"material", elastic(0.3)}};
    Part part = body(Kind::shell, "body");
    std::get<Shell4>(part.element).warping_projection = projection;
    make_inviscid(part);
    deck.parts = {part};
    deck.time.end = 0.05;
    deck.time.step_scale = 0.3;  // of a row that is thrown alone the energy error of the first steps is some
                                 // hundredths otherwise
    Mesh mesh = mesh_of(Kind::shell);
    // Every second node is an edge's length above its neighbours: the corners of a cube.
    for (Vector3d& x : mesh.position) x[2] = (std::lround((x[0] + x[1]) / 0.1) % 2 == 0 ? 0.5 : -0.5) * 0.1;
    InitialCondition kick = moving("body.xmin", {0.3, -0.2, 0.5});
    deck.initial_conditions = {kick};
    Model model = build(deck, {&mesh, 1});
    ThreadTeam team(1);
    run(model, deck, team);
    std::printf("warped: %lld steps, error %.0e\n", static_cast<long long>(model.step),
                model.energy.error_max);
    EXPECT_LE(model.energy.error_max, 1e-2);
    EXPECT_LE(model.energy.kinetic, 1.001 * model.energy.kinetic_start);
  }
}

}  // namespace
}  // namespace brio

#pragma once
/// The state of a run. Only build, advance and output use it as a whole; every other function takes its
/// parts. A feature that a deck does not name is an empty vector here: no loop body runs and nothing is
/// allocated.

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "contact/audit/audit.hpp"
#include "contact/impulse_sums.hpp"
#include "contact/scene.hpp"
#include "contact/start/initial_gap.hpp"
#include "contact/ties/ties.hpp"
#include "src/deck/deck.hpp"
#include "src/domains/schedule.hpp"
#include "src/model/force_sums.hpp"
#include "src/model/merged_parts.hpp"
#include "src/model/probes.hpp"
#include "src/model/scene_extent.hpp"
#include "src/model/stage_times.hpp"
#include "src/motion/constraints.hpp"
#include "src/motion/damping.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/motion/loads.hpp"
#include "src/motion/motion.hpp"
#include "src/motion/node_rotations.hpp"
#include "src/motion/rigid.hpp"
#include "src/motion/springs.hpp"
#include "src/sweep/assembled_step.hpp"
#include "src/sweep/erosion.hpp"
#include "src/sweep/mass_scaling.hpp"
#include "src/sweep/particles.hpp"
#include "src/sweep/step_size.hpp"
#include "src/sweep/surface_numbers.hpp"

namespace brio {

/// Contact audits so far, one a dump of fields.
struct ContactAudits {
  Audit found;  ///< summed
  std::int64_t dumps = 0;
  std::int64_t crossed_dumps = 0;  ///< with any crossing
  double time_of_deepest_crossing = 0;
  double time_of_deepest_too_close = 0;
};

struct Model {
  // Compiled once: they are a third of the code of a source that takes them.
  Model();
  Model(const Model&);
  Model(Model&&) noexcept;
  Model& operator=(const Model&);
  Model& operator=(Model&&) noexcept;
  ~Model();

  std::int64_t step = 0;             ///< steps made
  std::int64_t element_updates = 0;  ///< elements swept, summed over the steps
  StepTimes times;
  StepControl control;
  Nodes nodes;
  SceneExtent extent;  ///< of the nodes at the start
  std::vector<Block> blocks;
  std::vector<PartInModel> parts;
  std::unordered_map<std::string, std::size_t> part_number;  ///< by name
  std::vector<MergedParts> merged;                           ///< one a merge
  Ties ties;
  SweepSchedule schedule;
  std::vector<SweepResult> sweep_results;  ///< one a task
  AssembledStep assembled_step;
  std::vector<ParticleSearch>
      particle_searches;  ///< of blocks of particles with an updated-Lagrangian kernel
  std::vector<ActiveLoad> loads;
  Springs springs;
  NodalDamping damping;     ///< empty unless a part is damped
  NodeRotations rotations;  ///< if the deck asks for them in the fields
  std::vector<PrescribedNodes> prescribed;
  std::vector<WallInRun> walls;
  std::vector<ContactWall> contact_walls;  ///< the same, as contact takes them in a step
  RigidBodies rigid;
  std::vector<ContactScene> contacts;            ///< one if the deck names contact, else none
  std::optional<ContactAudits> contact_audits;   ///< if the deck asks for them
  ImpulseSums impulse_sums;                      ///< with contact: since the last dump of fields
  std::vector<InitialOverlap> initial_overlaps;  ///< removed before the first step

  std::optional<Erosion> erosion;                 ///< if elements can be deleted
  std::optional<SurfaceNumbers> surface_numbers;  ///< if elements can be deleted and the deck names contact

  std::optional<AddedMass> added_mass;  ///< if the deck asks for mass scaling

  EnergyBalance energy;
  std::vector<PartEnergy> part_energy;  ///< one a part
  double hourglass_warning = 0;         ///< limit of the ratio of hourglass to internal energy
  MomentumBalance momentum;
  std::vector<ProbeInRun> probes;           ///< one a probe of the deck
  std::optional<ForceSums> forces;          ///< if the deck asks for forces in the history
  bool tells_rigid_bodies = false;          ///< whether the deck asks for their motion in the history
  bool tells_part_energies = false;         ///< whether the deck asks for those of each part
  std::vector<KineticEnergy> kinetic_sums;  ///< one a range of nodes
  StageTimes stages;
};

/// Whether the assembled elements bound the time step instead of each by itself. The masses of ties and of
/// joined nodes of rigid parts are not those of their elements.
inline bool bounds_assembled_step(const Model& model) {
  return model.control.settings.step_bound != StepBound::elements && model.ties.empty() &&
         !model.rigid.has_joints();
}

}  // namespace brio

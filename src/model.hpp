#pragma once
/// What runs. Only build, advance and output see it whole; every other function takes its parts. What a deck
/// does not name is an empty vector here: no loop body runs and nothing is allocated.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contact/overlap.hpp"
#include "contact/scene.hpp"
#include "src/constraints.hpp"
#include "src/deck.hpp"
#include "src/ledger.hpp"
#include "src/loads.hpp"
#include "src/motion.hpp"
#include "src/rigid.hpp"
#include "src/schedule.hpp"
#include "src/stage_times.hpp"

namespace brio {

/// Where the nodes and elements of a part went.
struct PartInModel {
  std::string name;
  std::size_t block = 0;
  std::vector<int> node;           ///< node of the part's mesh -> node of the model
  std::vector<int> element_order;  ///< element of the block -> element of the part's mesh
  std::vector<int> element_slot;   ///< element of the part's mesh -> element of the block
  int rigid = -1;                  ///< the rigid body that it is; its block is empty
  double mass = 0;
};

/// The step and what bounds it.
struct StepControl {
  TimeSection settings;
  double stable = 0;               ///< of all elements, at the present time
  std::size_t critical_block = 0;  ///< where it is set
  std::size_t critical_element = 0;
  double held = 0;          ///< what the bound has left since it last grew
  double window_least = 0;  ///< least bound of the steps counted in `window`
  int window = 0;
  double first = 0;  ///< first step made
  double least = 0;
  double largest = 0;
};

struct Model {
  std::int64_t step = 0;  ///< steps made
  StepTimes times;
  StepControl control;
  Nodes nodes;
  std::vector<Block> blocks;
  std::vector<PartInModel> parts;
  SweepSchedule schedule;
  std::vector<SweepResult> sweep_results;  ///< one a task
  std::vector<ActiveLoad> loads;
  std::vector<PrescribedNodes> prescribed;
  std::vector<WallInRun> walls;
  RigidBodies rigid;
  std::vector<ContactScene> contacts;            ///< one if the deck names contact, else none
  std::int64_t missed_contacts = 0;              ///< counted by the audit, where the deck asks for it
  std::vector<InitialOverlap> initial_overlaps;  ///< removed before the first step

  EnergyBook energy;
  MomentumBook momentum;
  std::vector<KineticEnergy> kinetic_sums;  ///< one a range of nodes
  StageTimes stages;
};

}  // namespace brio

#pragma once
// The settings of a case: its tables `grid`, `run` and `contact`, and how it is executed. Members
// begin as a case has them that says nothing; what follows where it does say one: case/choices.py.
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "mpm/catalogue/setting.hpp"
#include "mpm/contact/settings.hpp"
#include "mpm/math/time_function.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/step/scheme.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {

struct CoarseningSettings {
  std::optional<std::int64_t> tiles, bytes;
  int times = 4;

  static constexpr std::string_view table = "grid.coarsening";
  using Self = CoarseningSettings;
  static constexpr Rule count{1.0, 1e15, false, false};
  static constexpr auto settings = std::tuple{
      Setting{"tiles", &Self::tiles,
              "the cells double when particles lie in more tiles than this; a tile is a block of "
              "4 x 4 x 4 cells (8 x 8 in 2D), counted once for each body in it",
              count},
      Setting{"bytes", &Self::bytes,
              "the cells double when the grid's nodes need more memory than this [bytes]", count},
      // Cells are a billion times as large then.
      Setting{"times", &Self::times, "how often at most", Rule{1.0, 30.0, false, false}}};
};

struct GridSettings {
  int dimension = 0;
  double cell_size = std::numeric_limits<double>::quiet_NaN();
  BasisId basis = basis_id<QuadraticBSpline>;

  static constexpr std::string_view table = "grid";
  using Self = GridSettings;
  static constexpr auto settings = std::tuple{
      Setting{"dimension", &Self::dimension, "2 (plane strain) or 3", Rule{2.0, 3.0, false, false}},
      Setting{"cell_size", &Self::cell_size, "edge of the square or cubic cells [m]",
              Rule::positive, "m"},
      Setting{"basis", &Self::basis,
              "shape functions. \"gimp\" (uniform GIMP, Bardenhagen & Kober 2004) and "
              "\"quadratic_bspline\" (Steffen, Kirby & Berzins 2008) stay accurate where stressed "
              "particles cross cells; \"linear\" is the paper's, the fastest"}};

  // What the case's corners come to. SI units.
  std::array<double, 3> origin{};         // position of a node, and of the box's lower corner [m]
  std::array<int, 3> box_cells{};         // cells of the box; 0, 0, 0 for no box
  std::array<Wall, 6> walls{};            // of the box's faces: x-, x+, y-, y+, z-, z+
  std::array<double, 6> wall_friction{};  // and Coulomb's coefficient of those that touch
  std::array<double, 3> outflow_lower{},
      outflow_upper{};   // corners of the region that is kept [m] ...
  bool outflow = false;  // ... if particles that leave it are taken out
  std::optional<CoarseningSettings> coarsening;
};

/// The transfer's word, and the numbers that go with it: `aflip = 0.97` names it too.
struct TransferSettings {
  TransferId word = Transfers::id_of<Aflip>();
  double flip = 1.0, aflip = 0.97, aflip_of_gases = 0.7, pic_rate = 0.0;
  int xpic = 4;
  std::int64_t every = 1;

  static constexpr std::string_view table = "run.transfer";
  using Self = TransferSettings;
  static constexpr auto settings = std::tuple{
      Setting{"flip", &Self::flip, "FLIP's share of a step's velocity, the rest being the grid's",
              Rule::share},
      Setting{"aflip", &Self::aflip,
              "the same of AFLIP, in a step in which the material's fastest wave passes half a "
              "cell; in shorter ones it takes as much less of the grid's",
              Rule::share},
      Setting{"aflip_of_gases", &Self::aflip_of_gases,
              "the same of gases and explosives, whose noise grows where it takes less, and whose "
              "heat it is; aflip itself where that is given and smaller",
              Rule::share},
      Setting{"pic_rate", &Self::pic_rate,
              "rate at which particles take over the velocity of the grid [1/s], beside \"flip\" "
              "or \"aflip\"; takes away noise that the grid does not see, over very long runs",
              Rule::not_negative, "1/s"},
      Setting{
          "xpic", &Self::xpic,
          "order of XPIC, how often velocities are mapped to the grid and back in a step: with "
          "1 it is \"pic\"; the larger, the less it takes of what the grid sees, and the longer "
          "a step takes",
          Rule{1.0, 1000.0, false, false}},
      Setting{"every", &Self::every,
              "steps from one with XPIC to the next; the others are \"flip\"",
              Rule{1.0, 1e15, false, false}}};

  /// FLIP's share of a step's velocity, where the transfer has one.
  double flip_share() const { return word == Transfers::id_of<Aflip>() ? aflip : flip; }
  double flip_share_of_gases() const {
    return word == Transfers::id_of<Aflip>() ? aflip_of_gases : flip;
  }
};

/// The way to rest under the loads of the time 0, before that time.
struct SettleSettings {
  double longest = std::numeric_limits<double>::quiet_NaN();
  double ratio = 1e-3, local = 0.8;

  static constexpr std::string_view table = "run.settle";
  using Self = SettleSettings;
  static constexpr Rule between{.lower = 0.0, .upper = 1.0, .lower_open = true, .upper_open = true};
  static constexpr auto settings = std::tuple{
      Setting{"longest", &Self::longest,
              "longest time of it [s]: the clock begins at minus that, and is set to 0 when forces "
              "balance",
              Rule::positive, "s"},
      Setting{"ratio", &Self::ratio,
              "it ends when the forces out of balance at the nodes are this share of gravity, body "
              "forces and loads, both summed over the nodes (FLAC's ratio)",
              between},
      Setting{"local", &Self::local,
              "local damping while it lasts of all bodies that deform, in place of their own; "
              "rigid ones "
              "that are free just fall",
              between}};
};

struct RunSettings {
  Scheme scheme = Scheme::usf;
  double cfl = 0.5;
  std::optional<double> time_step, largest_time_step;
  std::array<TimeFunction, 3> gravity{};
  TransferSettings transfer;
  double short_wave_damping = 0.0;
  double renewal_strain = 0.69;
  std::optional<SettleSettings> settle;
  double energy_growth_limit = 1.0;
  double outside_limit = 0.05;
  double volume_limit = 0.2;

  static constexpr std::string_view table = "run";
  using Self = RunSettings;
  static constexpr auto settings = std::tuple{
      Setting{"scheme", &Self::scheme, "when the stress is updated: \"usf\", \"usl\" or \"musl\""},
      Setting{"cfl",
              &Self::cfl,
              "share f of the largest stable step, 0 < f <= 1",
              Rule::fraction,
              {},
              "time_step_factor"},
      Setting{"time_step", &Self::time_step,
              "length of all steps, but for the last two, in place of the share `cfl` of the "
              "largest stable one; the run does not start, or stops, where it is larger than that",
              Rule::positive, "s"},
      Setting{"largest_time_step", &Self::largest_time_step,
              "no step is longer than this; default: no bound beyond `cfl`", Rule::positive, "s"},
      Setting{"gravity", &Self::gravity,
              "acceleration [m/s^2], D numbers or functions of time; default zero", Rule::any,
              "m/s^2"},
      Setting{"short_wave_damping", &Self::short_wave_damping,
              "bodies on nodes of their own lose what their particles do not see of the nodes' "
              "velocities at this rate, over the wave speed and the cells' size; 0 for never",
              Rule::not_negative},
      Setting{
          "renewal_strain", &Self::renewal_strain,
          "bodies on nodes of their own get these anew once one particle in a hundred has flowed "
          "by this plastic strain since the last time; 0 for never",
          Rule::not_negative},
      Setting{"energy_growth_limit", &Self::energy_growth_limit,
              "the run stops when the numerical error has created this share of the largest energy "
              "seen",
              Rule::positive},
      Setting{"outside_limit", &Self::outside_limit,
              "the run stops when more than this share of the particles of a body, or of all "
              "grains of an entry, lies beyond slip or fixed walls of the box; 1 for never",
              Rule::fraction},
      Setting{
          "volume_limit", &Self::volume_limit,
          "the run stops when more than this share of them has less than 0.01 or more than 100 "
          "times the volume that it began with (where the equation of state knows heat: and more "
          "than 100 cells too); gases, products of detonation and particles "
          "that have failed do not count; 1 for never",
          Rule::fraction}};
};

/// What moves no bit of the results.
struct ExecutionSettings {
  int threads = 1;
  int ranks = 1;
  bool fused = true;
  double disorder = disorder_that_pays;
  std::int64_t balance_every = 20;
  double imbalance_limit = 1.05;

  static constexpr std::string_view table = "execution";
  using Self = ExecutionSettings;
  static constexpr auto settings = std::tuple{
      Setting{"threads", &Self::threads, "threads, of each rank", Rule{1.0, 65536.0, false, false}},
      Setting{"ranks", &Self::ranks,
              "parts of the grid, each worked on by a thread of its own as by a process: to test "
              "that their number changes no result",
              Rule{1.0, 1024.0, false, false}},
      Setting{"fused", &Self::fused, "whether neighbouring stages of a step are done at once"},
      Setting{
          "disorder", &Self::disorder,
          "share of a body's particles that changes cell before its columns are sorted; infinite "
          "for never",
          Rule{.lower = 0.0, .lower_open = false, .finite = false}},
      Setting{"balance_every", &Self::balance_every,
              "steps after which ranks are looked at, as after the first one, and share out the "
              "tiles anew where one has too much",
              Rule{1.0, 1e9, false, false}},
      Setting{"imbalance_limit", &Self::imbalance_limit,
              "cost of a rank over the mean one from which on that is done; infinite for never",
              Rule{.lower = 1.0, .lower_open = false, .finite = false}}};
};

/// What is fixed before the bodies are added. SI units.
struct Settings {
  GridSettings grid;
  RunSettings run;
  ContactSettings contact;
  ExecutionSettings execution;
};

}  // namespace mpm

#pragma once
// What the device is compared on: every material in a body that strains, turns and crosses cells,
// free or in a box, with each basis, transfer and scheme.
#include <cmath>
#include <string>
#include <vector>

#include "mpm/run/bodies.hpp"
#include "mpm/run/prepare.hpp"

namespace mpm::testing {

inline MaterialChoice material(double density, const std::string& strength,
                               const std::map<std::string, double>& numbers) {
  MaterialChoice choice;
  choice.density = density;
  choice.strength = {strength, numbers};
  return choice;
}

/// One of each strength model and equation of state, soft enough to strain by percents.
inline std::vector<std::pair<std::string, MaterialChoice>> materials() {
  std::vector<std::pair<std::string, MaterialChoice>> all;
  const auto add = [&](const std::string& name, const MaterialChoice& choice) -> MaterialChoice& {
    all.emplace_back(name, choice);
    return all.back().second;
  };
  const std::map<std::string, double> stiff = {{"E", 70e9}, {"nu", 0.3}};
  const auto with = [](std::map<std::string, double> first,
                       const std::map<std::string, double>& more) {
    first.insert(more.begin(), more.end());
    return first;
  };
  add("elastic", material(2700.0, "elastic", stiff));
  add("j2", material(2700.0, "j2", with(stiff, {{"Y0", 1e8}, {"H", 1e9}})));
  add("voce", material(2700.0, "voce", with(stiff, {{"Y0", 1e8}, {"Q", 1e8}, {"b", 10.0}})));
  add("swift", material(2700.0, "swift", with(stiff, {{"Y0", 1e8}, {"e0", 0.01}, {"n", 0.2}})));
  const std::map<std::string, double> copper = {{"E", 124e9}, {"nu", 0.34},       {"A", 90e6},
                                                {"B", 292e6}, {"n", 0.31},        {"C", 0.025},
                                                {"m", 1.09},  {"T_melt", 1356.0}, {"cp", 383.0}};
  add("jc", material(8960.0, "johnson_cook", copper)).eos =
      ModelChoice{"mie_gruneisen", {{"c0", 3940.0}, {"s", 1.49}, {"gamma0", 1.96}}};
  MaterialChoice& shocked = add("jc, q", all.back().second);
  shocked.viscosity = {1.5, 0.06};
  add("simplified jc",
      material(8960.0, "simplified_johnson_cook",
               {{"E", 124e9}, {"nu", 0.34}, {"A", 90e6}, {"B", 292e6}, {"n", 0.31}, {"C", 0.025}}));
  add("drucker-prager",
      material(2000.0, "drucker_prager",
               {{"E", 1e9}, {"nu", 0.3}, {"q_phi", 0.4}, {"k_phi", 1e6}, {"tension", 1e5}}));
  add("mohr-coulomb",
      material(
          2000.0, "mohr_coulomb",
          {{"E", 1e9}, {"nu", 0.3}, {"cohesion", 1e6}, {"friction_angle", 0.5}, {"tension", 1e5}}));
  add("neo-hookean", material(1000.0, "neo_hookean", {{"K", 1e9}, {"G", 3e8}}));
  add("fluid, tait", material(1000.0, "fluid", {{"viscosity", 1e-3}})).eos =
      ModelChoice{"tait", {{"c0", 1480.0}}};
  add("fluid, ideal gas", material(1.2, "fluid", {})).eos =
      ModelChoice{"ideal_gas", {{"gamma", 1.4}, {"E0", 2.5e5}}};
  add("elastic, linear", material(2700.0, "elastic", stiff)).eos =
      ModelChoice{"linear", {{"K", 7e10}}};
  add("elastic, murnaghan", material(2700.0, "elastic", stiff)).eos =
      ModelChoice{"murnaghan", {{"K0", 7e10}, {"n", 4.0}}};
  add("elastic, polynomial", material(2700.0, "elastic", stiff)).eos =
      ModelChoice{"polynomial", {{"c1", 7e10}, {"c2", 1e11}, {"c4", 2.0}}};
  add("elastic, tillotson", material(2700.0, "elastic", stiff)).eos =
      ModelChoice{"tillotson",
                  {{"a", 0.5},
                   {"b", 1.63},
                   {"A", 7.5e10},
                   {"B", 6.5e10},
                   {"e0", 5e6},
                   {"e_iv", 3e6},
                   {"e_cv", 1.39e7}}};
  add("explosive", material(1630.0, "high_explosive", {{"D", 6930.0}})).eos = ModelChoice{
      "jwl",
      {{"A", 3.712e11}, {"B", 3.21e9}, {"R1", 4.15}, {"R2", 0.95}, {"omega", 0.3}, {"E0", 7e9}}};
  const MaterialChoice j2 = all[1].second, copper_with_eos = all[4].second;
  const auto failing = [](MaterialChoice choice, const std::string& model,
                          const std::string& action, const std::map<std::string, double>& numbers) {
    choice.failures.push_back({{model, numbers}, action});
    return choice;
  };
  add("jc, damage",
      failing(copper_with_eos, "johnson_cook_damage", "no_tension",
              {{"D1", 0.001}, {"D2", 0.002}, {"D3", -3.0}, {"D4", 0.01}, {"D5", 1.1}}));
  add("j2, two limits", failing(failing(j2, "plastic_strain", "no_shear", {{"limit", 0.004}}),
                                "principal_stress", "no_tension", {{"limit", 4e8}}));
  add("elastic, damped", all[0].second).damping = 1e-9;
  add("j2, eroding", failing(j2, "plastic_strain", "erode", {{"limit", 0.03}}));
  return all;
}

struct Problem {
  std::string basis = "quadratic_bspline", transfer = "aflip";
  Scheme scheme = Scheme::usf;
  int dimension = 3;
  int cells = 8;                           // along an edge of the body
  bool box = false;                        // in a corner of a box, with gravity
  bool two = false;                        // a second body, of an elastic material, meets it
  bool contact = false, impulses = false;  // in place of springs
  double speed = 0.03, strain = 0.01;  // of the translation and the straining over that of sound
  int threads = 1;
};

/// Two particles along each axis in each cell.
template <int D>
std::unique_ptr<Simulation<D>> make(const Problem& problem, const MaterialChoice& choice) {
  constexpr double h = 1e-3;
  Settings settings;
  settings.grid.dimension = D;
  settings.grid.cell_size = h;
  settings.grid.basis = choice_named<BasisId>("basis", problem.basis);
  settings.run.transfer.word = choice_named<TransferId>("transfer", problem.transfer);
  settings.run.scheme = problem.scheme;
  settings.run.cfl = problem.scheme == Scheme::usf ? 0.5 : 0.25;
  settings.contact.enabled = problem.contact;
  settings.contact.friction = 0.2;
  settings.contact.response = problem.impulses ? Response::impulses : Response::springs;
  settings.execution.threads = problem.threads;
  if (problem.box) {
    settings.grid.box_cells = {4 * problem.cells, 4 * problem.cells,
                               D == 3 ? 4 * problem.cells : 0};
    settings.grid.walls = {Wall::slip, Wall::free, Wall::fixed, Wall::free, Wall::slip, Wall::free};
    if (D == 2) settings.grid.walls[4] = settings.grid.walls[5] = Wall::free;
    settings.run.gravity[1] = TimeFunction(-1e6);
  }
  auto simulation = std::make_unique<Simulation<D>>(settings);
  const auto add = [&](const std::string& name, const MaterialChoice& of, double from, double way) {
    const int number = add_material(*simulation, of);
    const double c = sound_speed_at_start(simulation->domain.materials.back());
    const int n = 2 * problem.cells;
    const std::size_t count = static_cast<std::size_t>(std::pow(n, D) + 0.5);
    std::vector<double> positions(D * count), velocities(D * count);
    const double direction[3] = {0.8, -0.5, 0.3};
    std::size_t k = 0;
    for (int z = 0; z < (D == 3 ? n : 1); ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x, ++k) {
          const int i[3] = {x, y, z};
          for (int a = 0; a < D; ++a) {
            const double place = (i[a] + 0.5) / n;
            positions[D * k + static_cast<std::size_t>(a)] =
                (place * problem.cells + (a == 0 ? from : 0.0)) * h;
            // In a box it slides along the wall; elsewhere it flies; it breathes and shears.
            const double other = (i[(a + 1) % D] + 0.5) / n;
            velocities[D * k + static_cast<std::size_t>(a)] =
                c *
                (way * problem.speed * std::abs(direction[a]) *
                     (problem.box && a == 1 ? 0.0 : 1.0) +
                 problem.strain * (std::cos(3.14159 * place) + 0.5 * std::sin(3.14159 * other)));
          }
        }
    const double volume[1] = {std::pow(0.5 * h, D)};
    add_body(*simulation, name, number, positions, velocities, std::span<const double>(volume));
  };
  add("body", choice, 0.0, 1.0);
  if (problem.two) add("other", materials()[0].second, problem.cells, -1.0);
  prepare(*simulation);
  return simulation;
}

}  // namespace mpm::testing

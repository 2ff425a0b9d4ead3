#include "mpm/run/warnings.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace mpm {
namespace {

constexpr std::array face_names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
constexpr const char* crushed = "give smaller steps or cells, or a stiffer material";

/// `keeps`: it is a body on nodes of its own, which cannot break.
const char* remedy_for_torn(bool loaded, bool keeps) {
  if (keeps && !loaded)
    return "a body that keeps together may have been hit too fast or pressed too far: give "
           "artificial viscosity, lower run.cfl, or give frame = \"updated\", where it may break";
  return loaded
             ? "a load may have torn off a part of the surface: lower it, let it rise slowly, or "
               "give smaller cells"
             : "a particle may have been torn off: give its material a failure model with action "
               "= \"erode\", a spall_strength or artificial viscosity, or lower "
               "run.cfl";
}

/// Of a solid whose particles part.
std::string parted(const std::string& whose, double per_cent) {
  std::ostringstream text;
  text.precision(4);
  text << "particles of " << whose << " are more than a cell apart along an axis (" << per_cent
       << " % of its cells have an empty one beside them and particles behind it): it comes apart "
          "there by the numerics; give it a smaller spacing, or larger cells";
  return text.str();
}

/// Of a gas whose particles are far apart.
std::string too_sparse(const std::string& whose, double per_cent) {
  std::ostringstream text;
  text.precision(4);
  text << per_cent << " % of the particles of " << whose
       << " are more than 1.5 cells apart: on walls and on what it meets such a gas presses too "
          "little (a tenth at 1.7 cells, a fifth at 1.9); give it a smaller spacing, or larger "
          "cells";
  return text.str();
}

/// Of a gas whose particles have become too small or too large.
std::string no_room(const std::string& whose, double per_cent, double volume) {
  std::ostringstream text;
  text.precision(4);
  text
      << per_cent << " % of the particles of " << whose
      << " have less than 0.001 of their initial volume or stand for more than 100 cells, this one "
         "has "
      << volume
      << " of that at the start: the grid has no room for it; give run.transfer = \"aflip\" on the "
         "default basis, or smaller steps";
  return text.str();
}

/// Of a surface; `share`: of the reach of the springs.
std::string deep_in_another(const std::string& whose, double share) {
  std::ostringstream text;
  text.precision(4);
  text
      << "the surface of " << whose << " is " << share
      << " of the reach of its springs deep in a surface: beyond 1 they no longer hold, and bodies "
         "pass through each other, as they do where they meet at more than about a fifth of the "
         "speed of waves, or where a narrow tool stretches what it presses; give frame = "
         "\"updated\" to both, or fewer particles_per_cell, by which springs "
         "reach farther";
  return text.str();
}

/// Of a body into which nodes are not laid anew.
std::string nodes_stay(const std::string& whose, double per_cent, double why) {
  std::ostringstream text;
  text.precision(4);
  text << whose << " has flowed far, and its nodes are not laid anew into it, ";
  if (why == static_cast<double>(WhyNodesStay::parted))
    text << "as " << per_cent << " % of its particles would be more than 1.5 cells apart";
  else if (why == static_cast<double>(WhyNodesStay::folded))
    text << "as it is folded, and they would weld its faces";
  else
    text << "as particles of it have failed, and they would weld its pieces";
  text << ": its steps get shorter, its answers no worse";
  if (why == static_cast<double>(WhyNodesStay::parted))
    text << "; for longer steps give it more particles_per_cell";
  return text.str();
}

/// Of a body of which much has failed.
std::string mostly_failed(const std::string& whose, double per_cent) {
  std::ostringstream text;
  text.precision(4);
  text << per_cent << " % of the particles of " << whose
       << " have failed, which only walls and their own pressure stop where nodes lie in the body; "
          "for what debris does give frame = \"updated\"";
  return text.str();
}

/// Of a node at which so many bodies meet.
std::string crowded(double bodies) {
  std::ostringstream text;
  text.precision(4);
  text << bodies << " bodies meet at one node, and the time of a step grows with the square of "
       << "their number; give smaller cells, larger grains, or one body in place of many";
  return text.str();
}

/// Of a run whose settling was over too early.
std::string unbalanced(const Note& n) {
  std::ostringstream text;
  text.precision(4);
  text << "run.settle.longest was over before forces balanced: those out of balance were "
       << n.value << " of those applied, more than run.settle.ratio = " << n.against
       << "; give a longer time, or a larger ratio";
  return text.str();
}

/// What is so, and what can be done. `whose`: the body, or all of its entry.
std::string what_and_remedy(const Note& n, const std::string& whose, bool loaded, bool keeps) {
  std::ostringstream text;
  text.precision(4);
  const double per_cent = 100.0 * n.share;
  const char* const torn = remedy_for_torn(loaded, keeps);
  switch (n.kind) {
    case NoteKind::time_step:
      text << "the time step has fallen to " << n.value << " s, less than a tenth of " << n.against
           << " s, the largest median of 1000 steps so far, for the fastest particle; " << torn;
      break;
    case NoteKind::energy_made:
      text << "one step has made " << n.value
           << " J by numerical error, more than 5 % of the largest energy brought in so far ("
           << n.against << " J); " << torn;
      break;
    case NoteKind::load_energy:
      text << "loads have done the work " << n.value
           << " J in one step, more than 5 % of the largest energy brought in so far (" << n.against
           << " J) and ten times the median; " << torn;
      break;
    case NoteKind::outside:
      text << per_cent << " % of the particles of " << whose
           << " lie beyond closed walls of the box, this one " << n.value << " cells; " << crushed;
      break;
    case NoteKind::volume:
      text << per_cent << " % of the particles of " << whose
           << " have less than 0.01 or more than 100 times their initial volume, this one "
           << n.value << "; " << (n.value < 1.0 ? crushed : torn);
      break;
    case NoteKind::gas_volume:
      text << no_room(whose, per_cent, n.value);
      break;
    case NoteKind::sparse:
      text << parted(whose, per_cent);
      break;
    case NoteKind::sparse_gas:
      text << too_sparse(whose, per_cent);
      break;
    case NoteKind::crowd:
      text << crowded(n.value);
      break;
    case NoteKind::deep:
      text << deep_in_another(whose, n.value);
      break;
    case NoteKind::nodes_kept:
      text << nodes_stay(whose, per_cent, n.value);
      break;
    case NoteKind::failed:
      text << mostly_failed(whose, per_cent);
      break;
    case NoteKind::unsettled:
      text << unbalanced(n);
      break;
    case NoteKind::left_box:
      text << "particles of " << whose << " leave the box through its open face "
           << face_names[static_cast<std::size_t>(n.face)] << " (" << per_cent
           << " % at most so far)";
      break;
  }
  return text.str();
}

}  // namespace

template <int D>
std::string group_name(const Domain<D>& domain, int first) {
  const Body<D>& body = domain.body_at(first);
  const bool several = std::ranges::any_of(
      domain.bodies, [&](const Body<D>& b) { return b.group == first && &b != &body; });
  return "body \"" + body.name + '"' + (several ? " and those grouped with it" : "");
}

template <int D>
std::vector<Warning> warnings(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  std::vector<Warning> told;
  for (const Note& n : simulation.watch.notes) {
    Warning& w = told.emplace_back();
    w.kind = note_names[static_cast<std::size_t>(n.kind)];
    w.body = n.body;
    w.particle = n.particle;
    w.step = n.step;
    w.time = n.time;
    w.position = n.position;
    w.share = n.share;
    w.count = n.count;
    const bool of_no_place = n.kind == NoteKind::nodes_kept || n.kind == NoteKind::failed;
    w.is_error = n.kind != NoteKind::left_box && !of_no_place;
    const bool loaded =
        std::ranges::any_of(domain.loads, [&](const auto& load) { return load.body == n.body; });
    std::ostringstream text;
    text.precision(4);
    text << what_and_remedy(n, group_name(domain, n.group), loaded,
                            domain.body_at(n.body).keeps_nodes())
         << " (";
    if (n.kind != NoteKind::unsettled && !of_no_place) {
      text << "body \"" << domain.body_at(n.body).name << "\", ";
      if (n.particle >= 0) text << "particle " << n.particle << ", ";
      text << "at";
      for (std::size_t a = 0; a < D; ++a) text << ' ' << n.position[a];
      text << " m, ";
    }
    text << "step " << n.step << ", t = " << n.time << " s)";
    w.message = text.str();
  }
  return told;
}

template std::vector<Warning> warnings<2>(const Simulation<2>&);
template std::vector<Warning> warnings<3>(const Simulation<3>&);
template std::string group_name<2>(const Domain<2>&, int);
template std::string group_name<3>(const Domain<3>&, int);

}  // namespace mpm

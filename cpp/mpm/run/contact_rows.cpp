#include "mpm/run/contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

/// What two bodies, a < b, do to each other at a node: normal and impulse as for a.
struct NodeContact {
  int a, b;
  Vector3 node, normal, impulse;  // [m]; from a to b; on a, over the step [N s]
  double gap;                     // [m]
  double friction_impulse;        // its size [N s]
  double friction_work;           // [J]

  auto order() const { return std::tuple(a, b, node[2], node[1], node[0]); }
};

template <int D>
NodeContact at_node(const ContactPair<D>& pair, int r, int s, const Vector3& node) {
  const double sign = r < s ? 1.0 : -1.0;
  const Vec<double, D>& friction = pair.friction_impulse;
  return {std::min(r, s),
          std::max(r, s),
          node,
          sign * in_space<D>(pair.normal),
          sign * in_space<D>(pair.impulse()),
          pair.gap,
          std::sqrt(dot(friction, friction)),
          pair.friction_work};
}

template <int D>
std::vector<NodeContact> contacts_here(Domain<D>& domain) {
  Contact<D>& contact = domain.contact;
  std::vector<NodeContact> found;
  for (ContactPart<D>& part : contact.parts)
    for (const ContactNode& node : part.nodes)
      for (const ContactPair<D>& pair : part.pairs_of(node)) {
        if (!pair.loaded) continue;
        const auto sides = part.sides_of(node);
        const Vec<double, D> x = domain.grid.position_of(place_of(contact, domain.grid, node));
        found.push_back(at_node(pair, sides[pair.r].body, sides[pair.s].body, in_space<D>(x)));
      }
  return found;
}

void add_those_of_others(Comm& comm, std::vector<NodeContact>& found) {
  if (comm.alone()) return;
  Mail mail;
  for (int rank = 0; rank < comm.size(); ++rank)
    if (rank != comm.rank() && !found.empty()) write_all<NodeContact>(letter_to(mail, rank), found);
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) found.push_back(reader.read<NodeContact>());
}

/// The row of one pair of bodies; none if nothing acts.
void add_row(std::span<const NodeContact> nodes, double time_step, std::vector<double>& rows) {
  double weight = 0.0, gap = std::numeric_limits<double>::infinity();
  double friction_impulse = 0.0, friction_work = 0.0;
  Vector3 point = Vector3::zero(), normal = Vector3::zero(), impulse = Vector3::zero();
  for (const NodeContact& node : nodes) {
    const double share = std::sqrt(dot(node.impulse, node.impulse));
    weight += share;
    point += share * node.node;
    normal += share * node.normal;
    impulse += node.impulse;
    gap = std::min(gap, node.gap);
    friction_impulse += node.friction_impulse;
    friction_work += node.friction_work;
  }
  if (!(weight > 0.0)) return;
  const double length = std::sqrt(dot(normal, normal));
  const auto add = [&](const Vector3& vector) { rows.insert(rows.end(), vector.c, vector.c + 3); };
  rows.push_back(nodes.front().a);
  rows.push_back(nodes.front().b);
  add((1.0 / weight) * point);
  add((length > 0.0 ? 1.0 / length : 0.0) * normal);
  rows.push_back(gap);
  add((1.0 / time_step) * impulse);
  rows.push_back(friction_impulse > 0.0 ? friction_work / friction_impulse : 0.0);
}

/// The row of bodies whose surfaces touch.
template <int D>
void add_row(const ActingBetween<D>& pair, double time_step, std::vector<double>& rows) {
  const double push = norm(pair.push);
  if (is_wall(pair.b) || !(push > 0.0)) return;
  const Vec<double, D> normal = (-1.0 / push) * pair.push;
  const double rub = norm(pair.on_first - dot(pair.on_first, normal) * normal);
  const auto add = [&](const Vec<double, D>& vector) {
    const Vector3 v = in_space<D>(vector);
    rows.insert(rows.end(), v.c, v.c + 3);
  };
  rows.push_back(pair.a);
  rows.push_back(pair.b);
  add((1.0 / pair.size) * pair.middle);
  add(normal);
  rows.push_back(-pair.overlap);
  add(pair.on_first);
  rows.push_back(rub > 0.0 && time_step > 0.0 ? pair.rub_work / (rub * time_step) : 0.0);
}

}  // namespace

template <int D>
std::vector<double> contact_rows(Domain<D>& domain) {
  std::vector<double> rows;
  if (domain.surfaces.meet)
    for (const ActingBetween<D>& pair : domain.surfaces.between)
      add_row(pair, domain.time_step, rows);
  if (!domain.has_contact() || domain.step == 0) return rows;
  // Behind these the pairs that meet at nodes.
  std::vector<NodeContact> found = contacts_here(domain);
  add_those_of_others(*domain.grid.partition.comm, found);
  // In this order sums are the same for any number of threads and ranks.
  std::ranges::sort(found, {}, &NodeContact::order);
  for (auto first = found.begin(); first != found.end();) {
    const auto last = std::find_if(first, found.end(), [&](const NodeContact& node) {
      return node.a != first->a || node.b != first->b;
    });
    add_row({first, last}, domain.time_step, rows);
    first = last;
  }
  return rows;
}

template std::vector<double> contact_rows<2>(Domain<2>&);
template std::vector<double> contact_rows<3>(Domain<3>&);

}  // namespace mpm

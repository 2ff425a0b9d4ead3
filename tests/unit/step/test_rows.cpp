// What the rows of the stages say: a stage does the same where all that its row does not name as
// read is no number, and what it does not name as written stays as it is.
#include <bit>
#include <set>
#include <string>

#include "check.hpp"
#include "step/twin.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// A number of the domain, and the data that it is of: several where these share its place.
struct Number {
  double* exact = nullptr;
  Storage* rounded = nullptr;
  std::uint64_t data = 0;

  double get() const { return exact ? *exact : double{*rounded}; }
  void set(double value) const {
    if (exact)
      *exact = value;
    else
      *rounded = static_cast<Storage>(value);
  }
};

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

/// All numbers that stages work on, but those of contact and of the ledger.
template <int D>
class Numbers {
 public:
  /// Anew, as lists and blocks may have been.
  const std::vector<Number>& of(Domain<D>& domain) {
    all_.clear();
    for (std::size_t p = 0; p < domain.grid.patches.size(); ++p) {
      const Patch<D>& patch = domain.grid.patches[p];
      add_particles(domain.pool_of(patch), patch, domain.body_of(patch).deforms());
      add_nodes(domain, patch, domain.grid.block(p));
      add_sums(domain.sums[p]);
      domain.face_parts[p].for_each(
          [&](double& x) { add(x, Data::impulses | Data::mapped_impulses); });
    }
    return all_;
  }

 private:
  std::vector<Number> all_;

  void add(double& x, std::uint64_t data) { all_.push_back({&x, nullptr, data}); }
  void add_particles(ParticlePool<D>& pool, const Patch<D>& patch, bool deforms) {
    for (const ColumnInfo& column : pool.columns.infos()) {
      const std::uint64_t data = deforms ? data_of(pool, column.first) : rigid_data(pool, column);
      for (int c = column.first; c < column.first + column.components; ++c)
        for (const std::uint32_t row : pool.rows(patch)) {
          Number number{.data = data};
          if (column.kept == Precision::exact)
            number.exact = pool.columns.component(c) + row;
          else
            number.rounded = pool.columns.rounded(c) + row;
          all_.push_back(number);
        }
    }
    for (const std::uint32_t row : pool.rows(patch))
      for_each_piece_of(pool, row, [&](SurfacePiece<D>& piece) {
        for (int a = 0; a < D; ++a) {
          add(piece.area[a], Data::load_pieces);
          add(piece.arm[a], Data::load_pieces);
        }
      });
  }
  static std::uint64_t data_of(const ParticlePool<D>& pool, int column) {
    if (column == pool.position) return Data::position;
    if (column == pool.at.velocity) return Data::velocity;
    if (column == pool.at.mass) return Data::mass;
    if (column == pool.at.volume) return Data::volume;
    if (column == pool.affine) return Data::affine;
    if (column == pool.unseen) return Data::unseen;
    if (column == pool.at.force_pressure) return Data::force_pressure;
    if (column == pool.body_force || column == pool.start_position) return Data::body_force;
    const bool heated =
        pool.at.heat_owed >= 0 && (column == pool.at.energy || column == pool.at.recoverable);
    if (column == pool.at.growth_limit || column == pool.at.heat_owed || heated)
      return Data::flowing;
    if (column == pool.set_back) return 0;  // of the start alone
    return Data::stress;
  }
  static std::uint64_t rigid_data(const ParticlePool<D>& pool, const ColumnInfo& column) {
    if (column.first == pool.position) return Data::rigid_position;
    if (column.first == pool.at.velocity) return Data::rigid_velocity;
    return Data::rigid_position | Data::rigid_velocity;
  }
  void add_nodes(const Domain<D>& domain, const Patch<D>& patch, const NodeBlock<D>& block) {
    for (int n = 0; n < block.count; ++n) {
      add(block.records[n][mass_at], Data::node_mass);
      add(block.records[n][volume_at], Data::node_volumes);
      for (int a = 0; a < D; ++a) {
        add(block.records[n][velocity_at + a], Data::node_momentum | Data::node_velocity);
        add(block.records[n][force_at + a],
            Data::ghost_weights | Data::node_force | Data::node_increments | Data::node_remapped);
        if (domain.grid.has_dashpots && patch.at_wall)
          add(block.dashpots()[n][a], Data::node_dashpots);
      }
      if (block.springs.data != nullptr)
        for (int k = 0; k < wall_record; ++k)
          if (k % half_record < D) add(block.springs[n][k], Data::node_springs);
    }
  }
  void add_sums(PatchSums<D>& sums) {
    sums.for_each(
        [&](double& x) { add(x, &x == &sums.carried ? Data::carried_sums : Data::patch_sums); });
    for (const auto part : AngularImpulses::all())
      for (int a = 0; a < 3; ++a)
        add((sums.angular.*part)[a],
            part == &AngularImpulses::mapped ? Data::mapped_impulses : Data::impulses);
  }
};

std::string names_of(std::uint64_t data) {
  std::string names;
  for (std::size_t bit = 0; bit < data_names.size(); ++bit)
    if (data >> bit & 1u) names += (names.empty() ? "" : "/") + std::string(data_names[bit]);
  return names;
}

/// Two domains that begin alike: in one of them a stage finds no number where it does not say that
/// it reads.
template <int D>
class Poisoned {
 public:
  Poisoned(Report& report, const Choice<D>& choice, double start)
      : report_(report), healthy_(choice), poisoned_(choice) {
    for (Twin<D>* twin : {&healthy_, &poisoned_}) twin->domain.time = start;
  }

  void begin_step() {
    healthy_.begin_step();
    poisoned_.begin_step();
  }
  void end_step() {
    healthy_.end_step();
    poisoned_.end_step();
  }

  void run(const Stage<D>& stage) {
    const std::uint64_t reads = stage.reads, writes = stage.writes;
    before_.clear();
    for (const Number& number : ours_.of(healthy_.domain)) before_.push_back(number.get());
    for (const Number& number : theirs_.of(poisoned_.domain))
      if (number.data != 0 && !(number.data & reads)) number.set(not_a_number);
    stage.run(healthy_.domain);
    stage.run(poisoned_.domain);
    const std::vector<Number>&now = ours_.of(healthy_.domain),
          &theirs = theirs_.of(poisoned_.domain);
    CHECK(now.size() == theirs.size(), stage.name);
    const bool listed = writes & Data::lists;  // anew: what was where before is not known
    std::set<std::string> changed, missed;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double value = now[k].get(), other = theirs[k].get();
      const std::uint64_t data = now[k].data;
      const bool idle = listed && data & of_nodes;  // lent to the lists: nothing is in it yet
      const bool stays = !listed && same(value, before_[k]);
      if (!(data & writes) && !listed && !stays) changed.insert(names_of(data));
      const bool spoilt = data != 0 && !(data & reads) && other != other && (listed || stays);
      if (!idle && !spoilt && !same(value, other)) missed.insert(names_of(data));
      theirs[k].set(value);
    }
    const auto told = [](const std::set<std::string>& found) {
      std::string all;
      for (const std::string& one : found) all += (all.empty() ? "" : ", ") + one;
      return all;
    };
    CHECK(changed.empty(), stage.name, D, "writes without saying so", told(changed));
    CHECK(missed.empty(), stage.name, D, "reads more than it says: changes", told(missed));
  }

 private:
  static constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::uint64_t of_nodes = Data::node_mass | Data::node_momentum |
                                            Data::node_force | Data::node_dashpots |
                                            Data::node_springs | Data::node_volumes;
  Report& report_;
  Report& report = report_;  // of CHECK
  Twin<D> healthy_, poisoned_;
  Numbers<D> ours_, theirs_;
  std::vector<double> before_;
};

template <int D>
void check_rows(Report& report, const Choice<D>& choice, double start = 0.0) {
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl})
    for (const bool fused : {false, true}) {
      Extra extra = filters(choice.transfer) ? Extra::filter : Extra::none;
      const bool takes = takes_grid_velocity(choice.transfer) || choice.pic_rate > 0.0;
      if (choice.contact && (takes || choice.flip_share < 1.0)) extra = Extra::release;
      Poisoned<D> both(report, choice, start);
      for (int step = 0; step < 2; ++step) {
        both.begin_step();
        for (const Stage<D>& stage : stages_of<D>(scheme, fused, extra)) both.run(stage);
        both.end_step();
      }
    }
}

/// All that a step can have at once.
template <int D>
Choice<D> full(BasisId basis, TransferId transfer) {
  Choice<D> choice;
  choice.basis = basis;
  choice.transfer = transfer;
  choice.walls = {Wall::fixed, Wall::absorbing, Wall::contact, Wall::slip};
  choice.contact = choice.load = choice.body_force = choice.damping = true;
  return choice;
}

template <int D>
void check_all(Report& report) {
  Bases::for_each([&](BasisId basis, const auto&) {
    Transfers::for_each([&]<class Transfer>(TransferId transfer, const Transfer&) {
      if (Transfer::affine && second_moment(basis) == 0.0) return;
      Choice<D> choice = full<D>(basis, transfer);
      if (Transfer::has_share) choice.flip_share = 0.9;
      if (Transfer::filters) choice.filter_order = 3;
      for (const bool flows : {false, true}) {
        choice.flows = flows;
        check_rows(report, choice);
      }
      choice.flows = false;
      check_rows(report, choice, -1.0);  // as it settles
      choice.springs = choice.averages = true;
      check_rows(report, choice);
      for (const BodyKind kind : {BodyKind::rigid, BodyKind::prescribed}) {
        choice.kind = kind;
        check_rows(report, choice);
      }
    });
  });
}

}  // namespace

void test_rows(Report& report) { check_all<2>(report); }

void test_rows_in_space(Report& report) { check_all<3>(report); }

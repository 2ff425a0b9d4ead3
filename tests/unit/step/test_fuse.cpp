// Fused lists follow from what stages read and write; a fusion that would change a step is refused.
#include <algorithm>

#include "check.hpp"
#include "mpm/step/scheme.hpp"

namespace {

using namespace mpm;

template <int D>
std::size_t place(Scheme scheme, bool fused, std::string_view name) {
  const auto list = stages_of<D>(scheme, fused);
  return static_cast<std::size_t>(std::ranges::find(list, name, &Stage<D>::name) - list.begin());
}

template <int D>
void check_fused(mpm::testing::Report& report) {
  using S = Stages<D>;
  // The stress is updated between the mappings, from the first and for the second.
  CHECK_THROWS(fuse(Schemes<D>::usf, S::map_both), "needs the first");
  CHECK_THROWS(fuse(Schemes<D>::usf, S::exchange_both), "needs the first");
  // The second of two must be there.
  CHECK_THROWS(fuse(Schemes<D>::usf, S::advance_and_remap), "not in this order");
  // Positions may not change while the stress is still to be updated at the old ones.
  CHECK_THROWS(fuse(Schemes<D>::usl, S::advance_and_move), "needs the first");
  // Loads act before nodes are exchanged, also where that comes early.
  for (const Scheme scheme : {Scheme::usl, Scheme::musl}) {
    const std::size_t exchange = place<D>(scheme, true, "exchange momentum and forces");
    CHECK_EQUAL(place<D>(scheme, true, "fold forces") + 1, exchange);
    CHECK(place<D>(scheme, true, "load surfaces") < place<D>(scheme, true, "fold forces"));
    CHECK(place<D>(scheme, true, "body forces") < place<D>(scheme, true, "fold forces"));
    CHECK(exchange < place<D>(scheme, true, "contact momentum"));
  }
  // Fields that share a place: who writes one takes the others.
  const Stage<D> reader{"reader", nullptr, Data::node_force, Data::records};
  const Stage<D> writer{"writer", nullptr, Data::mass, Data::node_increments};
  const Stage<D> other{"other", nullptr, Data::mass, Data::node_velocity};
  CHECK(!independent(reader, writer) && !independent(writer, reader));
  CHECK(independent(reader, other));
  // Stages that some transfers want cost the others nothing.
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl})
    for (const bool fused : {false, true}) {
      const std::size_t plain = stages_of<D>(scheme, fused).size();
      CHECK_EQUAL(place<D>(scheme, fused, "filter velocities"), plain);
      CHECK_EQUAL(stages_of<D>(scheme, fused, Extra::filter).size(), plain + 1);
      CHECK(stages_of<D>(scheme, fused, Extra::release).size() >= plain + 2);
      // So do those of bodies on nodes of their own.
      CHECK_EQUAL(place<D>(scheme, fused, "update in the body"), plain);
      CHECK_EQUAL(stages_of<D>(scheme, fused, Extra::none, true).size(), plain + 7);
    }
  // A stage of a list is found by its name and what it reads.
  for (const auto* lists : {&Schemes<D>::plain, &Schemes<D>::fused})
    for (const auto& kinds : *lists)
      for (const auto& extras : kinds)
        for (const StageList<D>& list : extras)
          for (std::size_t k = 0; k < list.count; ++k)
            CHECK(list.find(list.stages[k]) == k, list.stages[k].name);
  CHECK_EQUAL(stages_of<D>(Scheme::musl, false).size(),
              stages_of<D>(Scheme::musl, true).size() + 4);
}

}  // namespace

void test_fuse(mpm::testing::Report& report) {
  check_fused<2>(report);
  check_fused<3>(report);
  for (std::size_t k = 0; k < data_names.size(); ++k) CHECK(!data_names[k].empty(), k);
  CHECK_EQUAL(std::size_t{1} << (data_names.size() - 1), std::size_t{Data::kept_spins});
}

#pragma once
// The part of a grid that a rank has, and what it knows of others' (decision 0056). Patches in
// tiles of other ranks beside its own are foreign: they have nodes here, but no particles. All that
// gives to a node of an own patch comes from within a tile of it, so that lists of shared nodes,
// and the order of sums, are those of one rank that has all.
#include <map>

#include "mpm/comm/comm.hpp"
#include "mpm/grid/owners.hpp"
#include "mpm/grid/patch.hpp"

namespace mpm {

/// Nodes that follow one another in the block of a patch.
struct NodeRun {
  std::uint32_t patch;
  std::uint16_t first, count;
};

/// A rank with which nodes are exchanged.
struct Partner {
  int rank = 0;
  std::vector<NodeRun> give;  // of own patches, what it reads
  std::vector<NodeRun> take;  // of its patches, what is read here
};

/// A patch of another rank, as that tells of it.
template <int D>
struct ForeignPatch {
  std::int32_t body;
  Index<D> tile;
  std::uint64_t occupied;
  int rank;
  bool keeps;
};

/// Kinds of letters, each with its own mail.
struct PartitionMail {
  Mail migrants, patches, nodes, dashpots, springs, kept;
};

/// Which patches a stage goes through: those first of which others read nodes, and foreign ones;
/// the rest while what these have is on its way.
enum class PatchPart { all, edge, inside };

template <int D>
struct Partition {
  static inline NoOthers nobody;

  Comm* comm = &nobody;
  Owners<D> owners;
  // Who has a tile reads all nodes there: bodies meet, and it solves their contacts.
  bool shares_tiles = false;
  bool divided = false;  // owners have changed, and patches are still where they were
  std::vector<std::vector<int>> readers{{}};  // sets of other ranks; a patch has one's number
  std::map<std::vector<int>, int> reader_numbers{{{}, 0}};
  std::vector<Partner> partners;
  std::vector<std::uint32_t> edge, inside;  // numbers of patches
  PatchPart part = PatchPart::all;
  bool on_its_way = false;            // nodes have been sent that are not received yet
  std::vector<ForeignPatch<D>> told;  // scratch
  PartitionMail mail;

  /// Does an own patch lie in a tile that belongs to another rank now?
  bool leaves(const Patch<D>& patch) const { return divided && !owns(patch.tile); }
  bool alone() const { return comm->alone(); }
  bool owns(const Index<D>& tile) const { return owners.rank_of(tile) == comm->rank(); }
};

}  // namespace mpm

#pragma once
// Bodies and pools from what a user gives.
#include <optional>
#include <span>
#include <string>

#include "mpm/comm/comm.hpp"
#include "mpm/grid/tile_grid.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/particles/pool.hpp"

namespace mpm {

/// The pool of a material, with its columns declared and no particles. A wave's speed depends on
/// the size of the grid's cells where the material is viscous.
template <int D>
ParticlePool<D> make_pool(const Material& material, const TileGrid<D>& grid,
                          const TransferColumns& transfer = {});

/// A body of particles at `positions` (n, D) [m] with `velocities` (n, D) or (1, D) [m/s] and
/// `volumes` (n,) or (1,) [m^3], with the pool of its material, which it does not enter yet. Throws
/// std::invalid_argument with the body's name if they do not fit each other. A rank keeps its share
/// of them, one alone all.
template <int D>
Body<D> make_body(const std::string& name, const Material& material, const ParticlePool<D>& pool,
                  std::span<const double> positions, std::span<const double> velocities,
                  std::span<const double> volumes, std::optional<Share> share = {});

/// A body of `count` particles of one volume [m^3], of which this rank is given those of its share
/// and no others: their positions (n, D), and velocities (n, D) or (1, D).
template <int D>
Body<D> make_slice(const std::string& name, const Material& material, const ParticlePool<D>& pool,
                   std::size_t count, Share share, std::span<const double> positions,
                   std::span<const double> velocities, double volume);

/// Put the given particles of all bodies into the pools of their materials; a patch for each body
/// holds them, until lists are built. Throws std::length_error for more than 3e9 of one material.
template <int D>
void fill_pools(std::vector<ParticlePool<D>>& pools, const std::vector<Material>& materials,
                std::vector<Body<D>>& bodies, std::vector<Patch<D>>& patches);

/// Throws std::invalid_argument if any is not finite, with what they are.
void check_finite(std::span<const double> values, const std::string& what);

}  // namespace mpm

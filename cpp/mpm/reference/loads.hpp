#pragma once
// Loads on surfaces in the reference step: the surface term of the equation of motion, on pieces of
// the surface that particles carry (Sulsky, Chen & Schreyer 1994).
#include "mpm/loads/surface_load.hpp"
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// f(i, N) for the nodes around the middle of a piece, which is so far from its particle: N are the
/// hats, at a place held between the nodes around the particle, or in the box over which the
/// particle's own function is a mean.
template <int D, class F>
void for_each_hat_node(const Step<D>& step, const Vec<double, D>& particle,
                       const Vec<double, D>& middle, F&& f) {
  Vec<double, D> x;  // [cells]
  Index<D> low, high;
  for (int a = 0; a < D; ++a) {
    const double at = particle[a] / step.h;
    x[a] = std::clamp(at + middle[a] / step.h, std::min(std::floor(at), at - step.half_width),
                      std::max(std::floor(at) + 1.0, at + step.half_width));
    low[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::floor(x[a]));
    high[static_cast<std::size_t>(a)] = low[static_cast<std::size_t>(a)] + 1;
  }
  for_each_index<D>(low, high, [&](const Index<D>& i) {
    double N = 1.0;
    for (int a = 0; a < D; ++a) N *= linear(x[a] - i[static_cast<std::size_t>(a)]).N;
    if (N > 0.0) f(i, N);
  });
}

/// f(i, W) with quadratic B-splines: N_ip + d . grad N_ip + sum_k b_k d2N_ip/dx_k^2, d the way from
/// the particle to a place. b = r (2 a - r) / 2, a = |out_k|, r what is left of the way from the
/// particle back to the knot when steps of 2 a have been taken off; `out`, the way from the
/// particle out of the body, is d for the middle of a piece.
template <int D, class F>
void for_each_spline_node(const Step<D>& step, const Vec<double, D>& particle,
                          const Vec<double, D>& d, const Vec<double, D>& out, F&& f) {
  step.for_each_node(particle, [&](const Index<D>& i, double N, const Vec<double, D>& dN) {
    double W = N;
    for (int k = 0; k < D; ++k) {
      W += d[k] * dN[k];
      const double a = std::abs(out[k]) / step.h;
      if (a == 0.0) continue;
      const double at = particle[k] / step.h, knot = std::floor(at + 0.5) - 0.5;
      double r = out[k] > 0.0 ? at - knot : knot + 1.0 - at;
      while (r >= 2.0 * a) r -= 2.0 * a;
      double second = std::abs(at - i[static_cast<std::size_t>(k)]) < 0.5 ? -2.0 : 1.0;
      for (int l = 0; l < D; ++l)
        if (l != k) second *= quadratic(particle[l] / step.h - i[static_cast<std::size_t>(l)]).N;
      W += 0.5 * r * (2.0 * a - r) * second;
    }
    f(i, W);
  });
}

/// f(i, N) for the nodes that carry the middle of a piece.
template <int D, class F>
void for_each_loaded_node(const Step<D>& step, const Vec<double, D>& particle,
                          const Vec<double, D>& middle, F&& f) {
  if (step.spline)
    for_each_spline_node(step, particle, middle, middle, f);
  else
    for_each_hat_node(step, particle, middle, f);
}

/// f_i += sum N_i(x) f over the pieces, f = -p a or t |a|, of p and t the means over the step; x is
/// the middle of the piece. N_i are the hats, but with B-splines; for hats x is held between the
/// nodes around the particle, or in the box over which the particle's own function is a mean.
template <int D>
void load_surfaces(Step<D>& step) {
  for (Body<D>& b : step.bodies)
    for (auto& [i, node] : b.nodes) node.f_load = Vec<double, D>::zero();
  for (Load<D>& load : step.loads) {
    Body<D>& b = step.bodies[load.body];
    Vec<double, D> value;
    for (int a = 0; a < D; ++a)
      value[a] = load.value[static_cast<std::size_t>(a)].mean(step.t, step.t + step.dt);
    load.force = Vec<double, D>::zero();
    for (const Piece<D>& piece : load.pieces) {
      const Vec<double, D> f = load.pressure ? -value[0] * piece.a : piece.size * value;
      load.force += f;
      for_each_loaded_node(step, b.particles[piece.particle].x, piece.middle,
                           [&](const Index<D>& i, double N) { b.nodes[i].f_load += N * f; });
    }
  }
  for (Body<D>& b : step.bodies) {
    step.fold(b, [](Node<D>& node, Node<D>& image, auto&& mirrored) {
      image.f_load += mirrored(node.f_load);
    });
    for (auto& [i, node] : b.nodes) {
      step.hold(i, node.f_load);
      node.f += node.f_load;
    }
  }
}

/// The pieces go with their particles: da' = cof(F) da (Nanson), dx' = F dx, F = (1 - L/2)^-1
/// (1 + L/2) the deformation of the step (Hughes & Winget 1980), L = dt sum v_i grad N_ip.
template <int D>
void carry_loads(Step<D>& step, Vec<double, D> Node<D>::* velocity, bool at_end) {
  for (Load<D>& load : step.loads)
    for (Piece<D>& piece : load.pieces) {
      Body<D>& b = step.bodies[load.body];
      Mat<double, D> L{};
      step.for_each_node(
          b.particles[piece.particle].x, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
            for (int a = 0; a < D; ++a)
              for (int c = 0; c < D; ++c)
                L[a][c] += (at_end ? step.dt_before : step.dt) * (b.nodes[i].*velocity)[a] * dN[c];
          });
      const Mat<double, D> F = deformation(L);
      const double before = norm(piece.a);
      piece.a = product(cofactor(F), piece.a);
      piece.size *= norm(piece.a) / before;
      piece.middle = product(F, piece.middle);
    }
}

}  // namespace mpm::reference

#pragma once
// Loads on surfaces in the reference step: the surface term of the equation of motion, on pieces of
// the surface that particles carry (Sulsky, Chen & Schreyer 1994).
#include "mpm/loads/surface_load.hpp"
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// f(i, N) with other bases, for the nodes around the middle of a piece, which is so far from
/// its particle: at a place held between the nodes around the particle.
template <int D, class F>
void for_each_hat_node(const Step<D>& step, const Vec<double, D>& particle,
                       const Vec<double, D>& middle, F&& f) {
  Vec<double, D> x;  // [cells]
  Index<D> low, high;
  for (int a = 0; a < D; ++a) {
    const double at = particle[a] / step.h;
    x[a] = std::clamp(at + middle[a] / step.h, std::floor(at), std::floor(at) + 1.0);
    low[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::floor(x[a]));
    high[static_cast<std::size_t>(a)] = low[static_cast<std::size_t>(a)] + 1;
  }
  for_each_index<D>(low, high, [&](const Index<D>& i) {
    double N = 1.0;
    for (int a = 0; a < D; ++a) N *= linear(x[a] - i[static_cast<std::size_t>(a)]).N;
    if (N > 0.0) f(i, N);
  });
}

/// b of a particle and of a face so far from it along an axis [cells], from what W_i of the
/// outermost node is where a stress is in balance with a pressure on the face: the sum of 2 a dN
/// over the particles behind, 2 a apart, with a = |out|. It is no more than |out| (N / l)^1/2 of
/// either node, l half the width of the box over which N is the mean of the hat; `part`, what the
/// normal's square has along the axis, counts for GIMP.
template <int D>
double second_order_of(const Step<D>& step, double at, double out, double part) {
  if (std::abs(out) < 1e-4) return 0.0;  // b is of the order of its square
  const double outwards = out > 0.0 ? 1.0 : -1.0, own = std::floor(at + 0.5);
  const auto S = [&](double x, double side) { return step.S(x - own - side); };
  double W = 0.0;
  double x = at;
  while (std::abs(x - own - outwards) < 2.0) {
    W += 2.0 * out * S(x, outwards).dN;
    x -= 2.0 * out;
  }
  const double b = W - S(at, outwards).N - out * S(at, outwards).dN;
  const double l = step.spline ? 0.5 : step.box, least = std::min(S(at, 1.0).N, S(at, -1.0).N);
  const double most = std::abs(out) * std::sqrt(std::max(least, 0.0) / l);
  return std::clamp(step.spline ? b : part * b, -most, most);
}

/// f(i, W) with GIMP and quadratic B-splines: N_ip + d . grad N_ip + sum_k b_k d2N_ip/dx_k^2, d the
/// way from the particle to a place; `out`, the way from the particle out of the body, is d for the
/// middle of a piece.
template <int D, class F>
void for_each_node_at(const Step<D>& step, const Vec<double, D>& particle, const Vec<double, D>& d,
                      const Vec<double, D>& out, F&& f) {
  Vec<double, D> b = Vec<double, D>::zero();
  for (int k = 0; k < D; ++k) {
    const double part = dot(out, out) > 0.0 ? out[k] * out[k] / dot(out, out) : 0.0;
    b[k] = second_order_of(step, particle[k] / step.h, out[k] / step.h, part);
  }
  step.for_each_node(particle, [&](const Index<D>& i, double N, const Vec<double, D>& dN) {
    double W = N + dot(d, dN);
    for (int k = 0; k < D; ++k) {
      const auto along = [&](int l) {
        return particle[l] / step.h - i[static_cast<std::size_t>(l)];
      };
      double second = std::abs(along(k)) < 0.5 ? -2.0 : 1.0;
      for (int l = 0; l < D; ++l)
        if (l != k) second *= step.S(along(l)).N;
      W += b[k] * second;
    }
    f(i, W);
  });
}

/// f(i, N) for the nodes that carry the middle of a piece.
template <int D, class F>
void for_each_loaded_node(const Step<D>& step, const Vec<double, D>& particle,
                          const Vec<double, D>& middle, F&& f) {
  if (step.spline || step.box > 0.0) {
    Vec<double, D> d;  // no further than the nodes beside that near to the particle
    for (int k = 0; k < D; ++k) {
      const double u = particle[k] / step.h - std::floor(particle[k] / step.h + 0.5);
      d[k] = step.h * std::clamp(middle[k] / step.h, -1.0 - u, 1.0 - u);
    }
    for_each_node_at(step, particle, d, d, f);
  } else {
    for_each_hat_node(step, particle, middle, f);
  }
}

/// f_i += sum N_i(x) f over the pieces, f = -p a or t |a|, of p and t the means over the step; x is
/// the middle of the piece.
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
      hold(step.walls_of(b), i, node.f_load);
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

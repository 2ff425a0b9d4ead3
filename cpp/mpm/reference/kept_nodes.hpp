#pragma once
// A step of a body on nodes of its own, as step/kept_nodes.hpp writes it: one particle and one node
// at a time. Nodes keep u and v, particles F; where these lie in the body, X, is that of the start.
#include "mpm/math/inverse.hpp"
#include "mpm/reference/followers.hpp"
#include "mpm/reference/loads.hpp"
#include "mpm/reference/step.hpp"

namespace mpm::reference {

template <int D>
struct KeptNodes {
  const Step<D>& step;  // shape functions, gravity, time step
  Body<D> body{};       // its nodes have masses and velocities
  Followers<D> followers{};
  std::map<Index<D>, Vec<double, D>> u{};  // [m]
  std::vector<Mat<double, D>> F{};         // of each particle
  std::vector<double> taken{};             // of its mean stress, by averaging [Pa]
  std::vector<Load<D>> loads{};            // pieces as they were at the start
  Vector3 L = Vector3::zero(), spin = L;   // of the body about its centre
  bool begun = false;
  unsigned held = 0;            // axes along which walls hold nodes of it, a bit each
  double kinetic_excess = 0.0;  // of the nodes [J]

  /// m_i = sum m_p N_ip once, and v_i as they are given by the index of the node.
  template <class Velocity>
  void start(Velocity&& velocity) {
    for (const Particle<D>& p : body.particles)
      step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>&) {
        body.nodes[i].m += p.m * N;
      });
    step.fold(body, [](Node<D>& node, Node<D>& image, auto&&) { image.m += node.m; });
    followers.find(step, body);
    const Walls<D> walls = step.walls_of(body);
    for (auto& [i, node] : body.nodes) {
      u[i] = Vec<double, D>::zero();
      if (!(node.m > 0.0)) continue;  // it follows, or stays at rest
      node.v = velocity(i);
      hold(walls, i, node.v);
    }
    take(&Node<D>::v);
    for (const auto& [i, node] : body.nodes) held |= walls.constrained_axes(i);
    Mat<double, D> one{};
    for (int a = 0; a < D; ++a) one[a][a] = 1.0;
    F.assign(body.particles.size(), one);
    taken.assign(F.size(), 0.0);
  }

  /// Of nodes that follow, and of those beyond walls.
  void take(Vec<double, D> Node<D>::* vector) {
    followers.take([&](const Index<D>& i) -> Vec<double, D>& { return body.nodes.at(i).*vector; });
    step.reflect(body, vector);
  }

  /// v -= R G R v of damp_short_waves.cpp, (W1); c over h for the time between such steps is
  /// `waves`.
  void damp_short_waves(double waves, double a) {
    using Velocities = std::map<Index<D>, Vec<double, D>>;
    const auto unseen = [&](const Velocities& v) {
      Velocities seen;  // m_i Q* Q v
      for (const auto& [i, of_node] : v) seen[i] = Vec<double, D>::zero();
      for (const Particle<D>& p : body.particles) {
        Vec<double, D> mean = Vec<double, D>::zero();
        Mat<double, D> C{};
        const auto arm = [&](const Index<D>& i, int k) {
          return step.h * i[static_cast<std::size_t>(k)] - p.X[k];
        };
        step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          for (int k = 0; k < D; ++k) {
            mean[k] += N * v.at(i)[k];
            for (int l = 0; l < D; ++l)
              C[k][l] += N * v.at(i)[k] * arm(i, l) / (0.25 * step.h * step.h);
          }
        });
        step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          for (int k = 0; k < D; ++k) {
            double field = mean[k];
            for (int l = 0; l < D; ++l) field += C[k][l] * arm(i, l);
            seen[i][k] += p.m * N * field;
          }
        });
      }
      followers.give([&](const Index<D>& i) -> Vec<double, D>& { return seen.at(i); });
      Velocities r = v;
      for (auto& [i, of_node] : r)
        if (body.nodes[i].m > 0.0) of_node -= (1.0 / body.nodes[i].m) * seen[i];
      followers.take([&](const Index<D>& i) -> Vec<double, D>& { return r.at(i); });
      return r;
    };
    Velocities v;
    for (const auto& [i, node] : body.nodes) v[i] = node.v;
    Velocities taken = unseen(v);
    for (auto& [i, r] : taken) r = std::min(waves * a, 1.0) * r;
    taken = unseen(taken);
    for (auto& [i, node] : body.nodes) node.v -= taken[i];
  }

  /// f_i = m_i g - sum V_p sigma_p F_p^-T grad_X N_ip, (M2).
  void map_forces() {
    for (auto& [i, node] : body.nodes) node.f = node.m * step.g;
    for (std::size_t k = 0; k < F.size(); ++k) {
      const Particle<D>& p = body.particles[k];
      const Mat<double, D> inverse = inverse_of(F[k]);
      step.for_each_node(p.X, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b)
            for (int c = 0; c < D; ++c)
              body.nodes[i].f[a] -=
                  p.V * (p.sigma(a, b) - (a == b ? taken[k] : 0.0)) * inverse[c][b] * dN[c];
      });
    }
  }

  /// f_i += sum N_i(X_p + A) f over the pieces, f = -p a or t |a|, with a = cof(F_p) a of the start
  /// and the size as much larger as that is longer, N_i those of reference/loads.hpp; of p and t
  /// the means over the time that forces act.
  void load_surfaces() {
    const double from = step.t - 0.5 * step.dt_before, to = step.t + 0.5 * step.dt;
    for (const Load<D>& load : loads) {
      Vec<double, D> value;
      for (int a = 0; a < D; ++a) value[a] = load.value[static_cast<std::size_t>(a)].mean(from, to);
      for (const Piece<D>& piece : load.pieces) {
        const Vec<double, D> area = product(cofactor(F[piece.particle]), piece.a);
        const double size = piece.size * norm(area) / norm(piece.a);
        const Vec<double, D> f = load.pressure ? -value[0] * area : size * value;
        for_each_loaded_node(step, body.particles[piece.particle].X, piece.middle,
                             [&](const Index<D>& i, double N) { body.nodes[i].f += N * f; });
      }
    }
  }

  /// What nodes beyond walls are given is their images'.
  void fold_forces() {
    step.fold(body,
              [](Node<D>& node, Node<D>& image, auto&& mirrored) { image.f += mirrored(node.f); });
  }
  /// And of who follows theirs who lead.
  void give_forces() {
    followers.give([&](const Index<D>& i) -> Vec<double, D>& { return body.nodes.at(i).f; });
  }

  /// (P1), (P2) of step/average_in_body.cpp, with b = .95.
  void average() {
    std::map<Index<D>, double> sums;
    const auto mean = [](const Particle<D>& p) {
      double sum = 0.0;
      for (int a = 0; a < D; ++a) sum += p.sigma(a, a) / D;
      return sum;
    };
    for (const Particle<D>& p : body.particles)
      step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>&) {
        sums[i] += p.V * mean(p) * N;
      });
    for (const auto& [j, leaders] : followers.of)
      for (const Leader<D>& leader : leaders) sums[leader.node] += leader.e * sums[j];
    for (auto& [i, sum] : sums)
      if (body.nodes[i].m > 0.0) sum /= body.nodes[i].m;
    for (const auto& [j, leaders] : followers.of) {
      sums[j] = 0.0;
      for (const Leader<D>& leader : leaders) sums[j] += leader.e * sums[leader.node];
    }
    for (std::size_t k = 0; k < F.size(); ++k) {
      const Particle<D>& p = body.particles[k];
      double projected = 0.0;
      step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>&) {
        projected += N * sums[i];
      });
      taken[k] = 0.95 * (mean(p) - p.m / p.V * projected);
    }
  }

  /// The nodes of a body turn with more inertia than it has, by D = m h^2 / 2 about each axis. L of
  /// the body changes by the moment of the forces, L_i = I (I - D)^-1 L is that of its nodes, and
  /// what this lacks is given to them by forces m_i alpha x r_i (particles/kept_spin.hpp).
  void turn() {
    if (held != 0) return;  // It is a part of what turns.
    double M = 0.0;
    Vector3 c = Vector3::zero(), p = c, now = c, moment = c;
    const auto place = [&](const Index<D>& i) {
      Vec<double, D> x = u[i];
      for (int a = 0; a < D; ++a) x[a] += step.h * i[static_cast<std::size_t>(a)];
      return in_space<D>(x);
    };
    for (const auto& [i, node] : body.nodes) {
      M += node.m;
      c += node.m * place(i);
      p += node.m * in_space<D>(node.v);
    }
    c = (1.0 / M) * c;
    Matrix3 I{};
    for (const auto& [i, node] : body.nodes) {
      const Vector3 r = place(i) - c;
      now += node.m * cross(r, in_space<D>(node.v) - (1.0 / M) * p);
      moment += cross(r, in_space<D>(node.f));
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) I[a][b] += node.m * ((a == b ? dot(r, r) : 0.0) - r[a] * r[b]);
    }
    const double excess = 0.5 * M * step.h * step.h, acts = 0.5 * (step.dt + step.dt_before);
    Matrix3 of_body = I;
    for (int a = 0; a < 3; ++a) of_body[a][a] -= excess;
    constexpr unsigned axes = D == 2 ? 4u : 7u;
    if (!begun) L = now - excess * spin_of(I, now, axes);
    begun = true;
    L += acts * moment;
    if constexpr (D == 3) {  // as it is turned in the middle of the step, of which L is
      const Matrix3 turned = rotation(0.5 * step.dt * spin_of(of_body, L, axes));
      of_body = turned * of_body * transposed(turned);
    }
    spin = spin_of(of_body, L, axes);
    Vector3 wanted = of_body * spin + excess * spin;
    if constexpr (D == 2) wanted = {0.0, 0.0, wanted[2]};
    const Vector3 alpha = (1.0 / acts) * spin_of(I, wanted - now - acts * moment, axes);
    for (auto& [i, node] : body.nodes) {
      const Vector3 f = node.m * cross(alpha, place(i) - c);
      for (int a = 0; a < D; ++a) node.f[a] += f[a];
    }
    kinetic_excess = 0.5 * excess * dot(spin, spin);
  }

  /// v_i += dt' f_i / m_i, u_i += dt v_i, (M3); walls hold what lies on them.
  void advance_nodes() {
    for (auto& [i, node] : body.nodes) {
      hold(step.walls_of(body), i, node.f);
      node.dv = (node.m > 0.0 ? 0.5 * (step.dt + step.dt_before) / node.m : 0.0) * node.f;
      node.v += node.dv;
    }
    take(&Node<D>::v);
    take(&Node<D>::dv);
    // (M5)
    const double before = step.dt_before, acts = 0.5 * (step.dt + before),
                 shift = before > 0.0 ? 0.125 * (before * before - step.dt * step.dt) : 0.0;
    double M = 0.0;
    Vec<double, D> of_body = Vec<double, D>::zero();
    for (const auto& [i, node] : body.nodes) {
      if (step.walls_of(body).image(i)) continue;
      M += node.m;
      of_body += node.m * node.dv;
    }
    for (int a = 0; a < D; ++a)
      if (held >> a & 1u) of_body[a] = 0.0;
    for (auto& [i, node] : body.nodes)
      u[i] += step.dt * node.v + (shift / acts) * (node.dv - (1.0 / M) * of_body);
  }

  /// x_p, F_p, (M1), and J dev sigma by L dt = (F_p - F_p before) (F_p before)^-1, (M4).
  void update() {
    for (std::size_t k = 0; k < F.size(); ++k) {
      Particle<D>& p = body.particles[k];
      Mat<double, D> now{}, change{};
      for (int a = 0; a < D; ++a) now[a][a] = 1.0;
      p.x = p.X;
      step.for_each_node(p.X, [&](const Index<D>& i, double N, const Vec<double, D>& dN) {
        p.x += N * u[i];
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) now[a][b] += u[i][a] * dN[b];
      });
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) change[a][b] = now[a][b] - F[k][a][b];
      StrainIncrement<double, D> motion{};
      motion.gradient = change * inverse_of(F[k]);
      const auto deviator_by = [&](double factor) {
        const double mean = trace(p.sigma) / 3.0;
        p.sigma = factor * p.sigma + Sym<double, D>::isotropic((1.0 - factor) * mean);
      };
      deviator_by(determinant(F[k]));
      body.material.update(motion, p.sigma);
      deviator_by(1.0 / determinant(now));
      p.V *= determinant(now) / determinant(F[k]);
      F[k] = now;
    }
  }
};

}  // namespace mpm::reference

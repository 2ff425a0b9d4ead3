#pragma once
// A whole step as the paper writes it (Ma, Zhang & Huang 2010, section 3.6): one particle and one
// node at a time, in doubles, without tiles, vectors or threads. Read it first. It is slow; what
// runs is in step/, and tests hold the stages there to it (tests/unit/step).
#include <functional>
#include <optional>
#include <type_traits>

#include "mpm/reference/affine.hpp"
#include "mpm/reference/shape.hpp"
#include "mpm/reference/state.hpp"
#include "mpm/walls/walls.hpp"

namespace mpm::reference {

template <int D>
struct Step;
template <int D>
void average_forces(const Step<D>& step, Body<D>& b);
template <int D>
void average_gradients(const Step<D>& step, Body<D>& b);
template <int D>
void set_prescribed_velocities(const Step<D>& step, Body<D>& b, Vec<double, D> Node<D>::* velocity);

/// Take away the components along the axes that walls hold at a node.
template <int D>
void hold(const Walls<D>& walls, const std::type_identity_t<Index<D>>& i, Vec<double, D>& v) {
  for (int a = 0; a < D; ++a)
    if (walls.constrained_axes(i) >> a & 1u) v[a] = 0.0;
}

/// The stages; those of contact, loads, walls, rigid and prescribed bodies, and the work of forces
/// have a file each beside this one.
template <int D>
struct Step {
  double h = 0.0, t = 0.0, dt = 0.0;          // cell size [m], time [s], time step [s]
  double dt_before = 0.0;                     // the step before [s]; 0 in the first
  Vec<double, D> g = Vec<double, D>::zero();  // gravity [m/s^2]
  double mu = 0.0;                            // coefficient of friction
  bool springs = false;                       // part bodies in contact, else impulses
  double pic = 0.0;                           // share of the grid's velocity that particles take
  double moment = 0.0;                        // D of an affine transfer [m^2]; 0 for none
  std::function<ShapeValue(double)> S;        // shape function along an axis, of d [cells]
  std::optional<double> averages;      // volumes over cells that begin so far before nodes [cells]
  std::function<double(double)> edge;  // of a particle of a volume [m], for springs
  bool spline = false;                 // is it the quadratic B-spline?
  double box = 0.0;                    // of uniform GIMP half the width of its boxes [cells]
  Walls<D> walls{};                    // the grid's node 0 is the lower corner of the box
  std::vector<Body<D>> bodies;
  std::vector<Load<D>> loads;
  std::vector<Contact<D>> contacts;  // of this step

  /// f(node, N_ip, grad N_ip [1/m]) for the nodes that a place reaches.
  template <class F>
  void for_each_node(const Vec<double, D>& x, F&& f) const {
    constexpr std::int32_t most = 4;  // along an axis
    Index<D> low, high;
    std::array<std::array<ShapeValue, most>, D> along;
    for (std::size_t a = 0; a < D; ++a) {
      const double at = x[static_cast<int>(a)] / h;
      low[a] = static_cast<std::int32_t>(std::floor(at)) - 1;
      high[a] = low[a] + most - 1;
      for (std::int32_t k = 0; k < most; ++k)
        along[a][static_cast<std::size_t>(k)] = S(at - (low[a] + k));
    }
    for_each_index<D>(low, high, [&](const Index<D>& i) {
      const auto s = [&](std::size_t a) {
        return along[a][static_cast<std::size_t>(i[a] - low[a])];
      };
      double N = 1.0;
      Vec<double, D> dN;
      for (std::size_t a = 0; a < D; ++a) {
        N *= s(a).N;
        double product = 1.0 / h;
        for (std::size_t b = 0; b < D; ++b) product *= a == b ? s(b).dN : s(b).N;
        dN[static_cast<int>(a)] = product;
      }
      if (N > 0.0) f(i, N, dN);
    });
  }

  /// v_p + C_p (x_i - x_p), the velocity that a particle gives to a node (Jiang et al. 2015).
  Vec<double, D> given(const Particle<D>& p, const Index<D>& i) const {
    Vec<double, D> v = p.v;
    for (int a = 0; a < D; ++a)
      for (int c = 0; c < D; ++c) v[a] += p.C[a][c] * arm(p, i)[c];
    return v;
  }
  Vec<double, D> arm(const Particle<D>& p, const Index<D>& i) const {
    Vec<double, D> d;
    for (int a = 0; a < D; ++a) d[a] = h * i[static_cast<std::size_t>(a)] - p.x[a];
    return d;
  }

  /// m_i = sum m_p N_ip, eq. (2); p_i = sum m_p v_p N_ip, eq. (3); v_i = p_i / m_i.
  void map_momentum() {
    for (Body<D>& b : bodies) {
      b.nodes.clear();
      for (const Particle<D>& p : b.particles)
        for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          b.nodes[i].m += p.m * N;
          b.nodes[i].v += p.m * N * given(p, i);
        });
      fold(b, [](Node<D>& node, Node<D>& image, auto&& mirrored) {
        image.m += node.m;
        image.v += mirrored(node.v);
      });
      find_velocities(b, &Node<D>::v);
    }
  }

  /// f_i = sum m_p N_ip g - sum V_p (sigma_p + s_p) . grad N_ip, eqs. (9)-(10).
  void map_forces() {
    for (Body<D>& b : bodies) {
      for (auto& [i, node] : b.nodes) node.f = Vec<double, D>::zero();
      if (b.prescribed()) continue;
      for (const Particle<D>& p : b.particles)
        for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>& dN) {
          for (int a = 0; a < D; ++a) {
            b.nodes[i].f[a] += p.m * N * g[a];
            for (int c = 0; c < D; ++c) b.nodes[i].f[a] -= p.V * (p.sigma + p.s)(a, c) * dN[c];
          }
        });
      if (averages) average_forces(*this, b);
      fold(b, [](Node<D>& node, Node<D>& image, auto&& mirrored) { image.f += mirrored(node.f); });
      for (auto& [i, node] : b.nodes) hold(walls, i, node.f);
    }
  }

  /// -alpha m v' - kappa |f| sgn v', v' = v + dt a / 2 with what both do to a: the local one is no
  /// more than what brings v' to rest.
  void find_damping(const Body<D>& b, Node<D>& node) const {
    for (int a = 0; a < D; ++a) {
      const double at_rest =
          node.f[a] + 2.0 * node.m * node.v[a] / dt;  // brings v' to rest, if taken
      const double local =
          std::clamp(at_rest, -b.kappa * std::abs(node.f[a]), b.kappa * std::abs(node.f[a]));
      const double middle =
          (node.v[a] + 0.5 * dt * (node.f[a] - local) / node.m) / (1.0 + 0.5 * dt * b.alpha);
      node.f_damp[a] = -local - b.alpha * node.m * middle;
    }
  }

  /// v_i += dt f_i / m_i, eq. (8).
  void advance_nodes() {
    for (Body<D>& b : bodies) {
      for (auto& [i, node] : b.nodes) {
        if (!b.prescribed()) {
          hold(walls, i, node.f);  // Friction of a prescribed body may act along a wall.
          find_damping(b, node);
          node.dv = (dt / node.m) * (node.f + node.f_damp);
        }
        node.v += node.dv;
      }
      reflect(b, &Node<D>::v);
      reflect(b, &Node<D>::dv);
    }
  }

  /// v_p += sum dv_i N_ip, eq. (17); of a share `pic` the velocity of the grid takes the place,
  /// that before eqs. (6)-(7) and with the increment; what a filter has found is taken away. C_p =
  /// sum N_ip v_i (x_i - x_p) / D of the same; with it, all of the grid's at fixed walls.
  void advance_particles() {
    for (Body<D>& b : bodies) {
      if (b.prescribed()) continue;
      for (Particle<D>& p : b.particles) {
        Vec<double, D> of_grid = Vec<double, D>::zero();
        Mat<double, D> C{};
        bool held = false;
        for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          held = held || (moment > 0.0 && walls.fixes_near(i, 0, 0));
          const Vec<double, D> v = b.nodes[i].v - b.nodes[i].v_corrected;
          p.v += N * b.nodes[i].dv;
          of_grid += N * v;
          if (moment > 0.0)
            for (int a = 0; a < D; ++a)
              for (int c = 0; c < D; ++c) C[a][c] += N * v[a] * arm(p, i)[c] / moment;
        });
        if (!b.deforms()) continue;
        p.v += (held ? 1.0 : pic) * (of_grid - p.v);
        p.v -= p.unseen;
        p.C = C;
      }
    }
  }

  /// MUSL: the nodes' velocities anew from those of the particles, section 3.6, step 10.
  void remap_momentum() {
    for (Body<D>& b : bodies) {
      for (auto& [i, node] : b.nodes) node.v_new = Vec<double, D>::zero();
      for (const Particle<D>& p : b.particles)
        for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          b.nodes[i].v_new += p.m * N * given(p, i);
        });
      fold(b, [](Node<D>& node, Node<D>& image, auto&& mirrored) {
        image.v_new += mirrored(node.v_new);
      });
      find_velocities(b, &Node<D>::v_new);
    }
  }

  /// Strain, rotation and stress by the gradient dt sum v_i grad N_ip, eqs. (18)-(20); USF and USL
  /// take the nodes' velocities `v`, MUSL the remapped ones. Those of USF have brought the
  /// particles here: L is on the configuration at the end of what it strains, F = (1 - L dt)^-1.
  /// And s_p = beta C : D, the stress of the material's damping, of the shape alone where volumes
  /// are averaged.
  void update_stress(Vec<double, D> Node<D>::* velocity, bool at_end) {
    for (Body<D>& b : bodies) {
      if (!b.deforms()) continue;
      for (Particle<D>& p : b.particles) {
        p.gradient = Mat<double, D>{};
        for_each_node(p.x, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
          for (int a = 0; a < D; ++a)
            for (int c = 0; c < D; ++c)
              p.gradient[a][c] += (at_end ? dt_before : dt) * (b.nodes[i].*velocity)[a] * dN[c];
        });
        const auto strain = symmetric_part(p.gradient);
        const double rate = b.beta / (at_end ? dt_before : dt), G = b.material.G,
                     lambda = averages ? -2.0 * G / D : b.material.lambda;
        p.s = (2.0 * rate * G) * strain + Sym<double, D>::isotropic(rate * lambda * trace(strain));
        if (at_end) p.gradient = seen_from_start(p.gradient);
      }
      if (averages) average_gradients(*this, b);
      for (Particle<D>& p : b.particles) {
        StrainIncrement<double, D> motion{};
        motion.gradient = p.gradient;
        b.material.update(motion, p.sigma);
        Mat<double, D> f = motion.gradient;
        for (int a = 0; a < D; ++a) f[a][a] += 1.0;
        p.V *= determinant(f);
      }
    }
  }

  /// x_p += dt sum v_i N_ip, eq. (16); C_p goes with the velocities that it describes.
  void move_particles() {
    for (Body<D>& b : bodies) {
      if (!b.deforms()) continue;
      for (Particle<D>& p : b.particles) {
        Vec<double, D> v = Vec<double, D>::zero();
        for_each_node(p.x, [&](const Index<D>& i, double N, const Vec<double, D>&) {
          v += N * b.nodes[i].v;
        });
        p.x += dt * v;
        carry_along(p.C, dt);
      }
    }
  }

  /// The walls as a body has them.
  Walls<D> walls_of(const Body<D>& b) const { return walls.as_held_by(b.held_by); }

  /// Nodes beyond a wall belong to a mirrored body. add(node, image, mirrored): what particles give
  /// to the node is the image's, vectors mirrored.
  template <class F>
  void fold(Body<D>& b, F&& add) const {
    for (auto& [i, node] : b.nodes)
      for_image(b, i, [&](Node<D>& image, auto&& mirrored) { add(node, image, mirrored); });
  }
  /// Such a node moves as its image does.
  void reflect(Body<D>& b, Vec<double, D> Node<D>::* velocity) const {
    if (b.prescribed()) return;
    for (auto& [i, node] : b.nodes)
      for_image(b, i, [&](Node<D>& image, auto&& mirrored) {
        node.*velocity = mirrored(image.*velocity);
      });
  }
  template <class F>
  void for_image(Body<D>& b, const Index<D>& i, F&& f) const {
    const auto image = walls_of(b).image(i);
    if (!image) return;
    f(b.nodes[image->node], [image](Vec<double, D> v) {
      for (int a = 0; a < D; ++a) v[a] = image->component(v[a], a);
      return v;
    });
  }
  /// From momenta to velocities.
  void find_velocities(Body<D>& b, Vec<double, D> Node<D>::* velocity) {
    if (b.prescribed()) return set_prescribed_velocities(*this, b, velocity);
    for (auto& [i, node] : b.nodes) {
      node.*velocity = (1.0 / node.m) * (node.*velocity);
      hold(walls, i, node.*velocity);
    }
    reflect(b, velocity);
  }
};

}  // namespace mpm::reference

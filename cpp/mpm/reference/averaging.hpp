#pragma once
// F-bar over the cells of a body in the reference step (Coombs et al. 2018).
#include "mpm/reference/step.hpp"

namespace mpm::reference {

/// f(particles) for the particles of each cell.
template <int D, class F>
void for_each_cell(const Step<D>& step, Body<D>& b, F&& f) {
  const double before = step.averages.value_or(0.0);
  std::map<Index<D>, std::vector<Particle<D>*>> cells;
  for (Particle<D>& p : b.particles) {
    Index<D> cell;
    for (int a = 0; a < D; ++a)
      cell[static_cast<std::size_t>(a)] =
          static_cast<std::int32_t>(std::floor(p.x[a] / step.h + before));
    cells[cell].push_back(&p);
  }
  for (auto& [cell, particles] : cells) f(particles);
}

/// F = 1 + gradient becomes (J-bar / J)^(1/D) F, J-bar the mean by volume of J = det F.
template <int D>
void average_gradients(const Step<D>& step, Body<D>& b) {
  const auto F = [](const Particle<D>& p) {
    Mat<double, D> f = p.gradient;
    for (int a = 0; a < D; ++a) f[a][a] += 1.0;
    return f;
  };
  for_each_cell(step, b, [&](const std::vector<Particle<D>*>& particles) {
    double before = 0.0, after = 0.0;
    for (const Particle<D>* p : particles) {
      before += p->V;
      after += p->V * determinant(F(*p));
    }
    for (Particle<D>* p : particles) {
      const Mat<double, D> f = F(*p);
      const double scale = std::pow(after / before / determinant(f), 1.0 / D);
      for (int a = 0; a < D; ++a)
        for (int c = 0; c < D; ++c) p->gradient[a][c] = scale * f[a][c] - (a == c ? 1.0 : 0.0);
    }
  });
}

/// f_i -= sum V_p (P-bar - P_p) grad N_ip: the mean stress of the cell in place of a particle's.
template <int D>
void average_forces(const Step<D>& step, Body<D>& b) {
  const auto mean_stress = [](const Particle<D>& p) {
    double sum = 0.0;
    for (int a = 0; a < D; ++a) sum += p.sigma(a, a);
    return sum / D;
  };
  for_each_cell(step, b, [&](const std::vector<Particle<D>*>& particles) {
    double volume = 0.0, mean = 0.0;
    for (const Particle<D>* p : particles) {
      volume += p->V;
      mean += p->V * mean_stress(*p);
    }
    for (const Particle<D>* p : particles)
      step.for_each_node(p->x, [&](const Index<D>& i, double, const Vec<double, D>& dN) {
        b.nodes[i].f -= p->V * (mean / volume - mean_stress(*p)) * dN;
      });
  });
}

}  // namespace mpm::reference

// Compiled for a device, not run: every basis, strength model, equation of state and failure model
// in a kernel, with the number that it has there.
#include "mpm/basis/basis.hpp"
#include "mpm/materials/catalogue.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

template <class B>
__global__ void weights(B basis, const double* xi, double* out) {
  const auto w = basis.along(xi[threadIdx.x]);
  for (int k = 0; k < B::nodes; ++k) out[threadIdx.x] += w.N[k] * w.dN[k];
}

template <int D, class M>
__global__ void stress(M model, const StrainIncrement<double, D>* motion, Sym<double, D>* stress,
                       typename M::template State<double, D>* state, double* work) {
  const unsigned i = threadIdx.x;
  work[i] = model.update(motion[i], stress[i], state[i]);
  if constexpr (requires { model.sound_speed(stress[i], state[i], 1.0); })
    work[i] += model.sound_speed(stress[i], state[i], 1.0);
  if constexpr (requires { model.other_speed_squared(state[i], 1.0); })
    work[i] += model.other_speed_squared(state[i], 1.0);
}

template <class M>
__global__ void pressure(M model, const double* V, double* out) {
  const auto p = line_of(model, V[threadIdx.x], V[threadIdx.x]);
  out[threadIdx.x] = p.A + p.B + p.dA + p.dB;
}

template <int D, class M>
__global__ void damage(M model, const Condition<double, D>* at,
                       typename M::template State<double, D>* state, double* out) {
  out[threadIdx.x] = model.damage(at[threadIdx.x], state[threadIdx.x]);
}

void instantiate() {
  Bases::for_each(
      []<class B>(BasisId, const B& basis) { weights<B><<<1, 32>>>(basis, nullptr, nullptr); });
  StrengthModels::for_each([]<class M>(const M& model) {
    stress<2, M><<<1, 32>>>(model, nullptr, nullptr, nullptr, nullptr);
    stress<3, M><<<1, 32>>>(model, nullptr, nullptr, nullptr, nullptr);
  });
  EosModels::for_each(
      []<class M>(const M& model) { pressure<M><<<1, 32>>>(model, nullptr, nullptr); });
  FailureModels::for_each([]<class M>(const M& model) {
    damage<2, M><<<1, 32>>>(model, nullptr, nullptr, nullptr);
    damage<3, M><<<1, 32>>>(model, nullptr, nullptr, nullptr);
  });
}

}  // namespace mpm

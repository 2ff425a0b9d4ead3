#pragma once
// Every material model, one line per kind. From it come the case keys, checks, documentation,
// columns and law tests.
#include <variant>

#include "mpm/materials/eos/ideal_gas.hpp"
#include "mpm/materials/eos/jwl.hpp"
#include "mpm/materials/eos/linear.hpp"
#include "mpm/materials/eos/mie_gruneisen.hpp"
#include "mpm/materials/eos/murnaghan.hpp"
#include "mpm/materials/eos/polynomial.hpp"
#include "mpm/materials/eos/tait.hpp"
#include "mpm/materials/eos/tillotson.hpp"
#include "mpm/materials/failure/energy_limit.hpp"
#include "mpm/materials/failure/hydrostatic_tension.hpp"
#include "mpm/materials/failure/johnson_cook_damage.hpp"
#include "mpm/materials/failure/maximum_shear.hpp"
#include "mpm/materials/failure/plastic_strain.hpp"
#include "mpm/materials/failure/principal_strain.hpp"
#include "mpm/materials/failure/principal_stress.hpp"
#include "mpm/materials/strength/drucker_prager.hpp"
#include "mpm/materials/strength/elastic.hpp"
#include "mpm/materials/strength/fluid.hpp"
#include "mpm/materials/strength/high_explosive.hpp"
#include "mpm/materials/strength/j2.hpp"
#include "mpm/materials/strength/johnson_cook.hpp"
#include "mpm/materials/strength/mohr_coulomb.hpp"
#include "mpm/materials/strength/neo_hookean.hpp"
#include "mpm/materials/strength/rigid.hpp"
#include "mpm/materials/strength/simplified_johnson_cook.hpp"
#include "mpm/materials/strength/swift.hpp"
#include "mpm/materials/strength/voce.hpp"

namespace mpm {

template <Model... Models>
struct Catalogue {
  using Any = std::variant<Models...>;
  /// f(model) for a default instance of each.
  template <class F>
  static void for_each(F&& f) {
    (f(Models{}), ...);
  }
};

using StrengthModels =
    Catalogue<Elastic, J2, Voce, Swift, JohnsonCook, SimplifiedJohnsonCook, DruckerPrager,
              MohrCoulomb, NeoHookean, Fluid, HighExplosive, Rigid>;
using EosModels =
    Catalogue<LinearBulk, Polynomial, MieGruneisen, Jwl, IdealGas, Tait, Murnaghan, Tillotson>;
using FailureModels =
    Catalogue<PlasticStrainLimit, PrincipalStressLimit, PrincipalStrainLimit, MaximumShearLimit,
              HydrostaticTensionLimit, JohnsonCookDamage, EnergyLimit>;

}  // namespace mpm

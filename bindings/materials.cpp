// The catalogue of material models, and one point of a material by itself.
#include "catalogue.hpp"
#include "mpm/particles/add_columns.hpp"
#include "mpm/particles/make_body.hpp"
#include "mpm/run/drive_material.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm::bindings {
namespace {

struct CatalogueParameter {
  std::string name, unit, meaning;
  Rule rule;
  std::optional<double> start;
};
struct CatalogueColumn {
  std::string name, unit;
};
struct CatalogueModel {
  std::string kind, name, doc, source;
  std::vector<CatalogueParameter> parameters;
  std::vector<CatalogueColumn> state;
  std::string eos;     // of a strength model: "never", "may", "must"
  bool flows = false;  // of a strength model: has it no shape of its own?
};

/// The names of the columns of particles of a material; `may_leave`: there is an outflow box,
/// `forced`: a body force, which is a formula `of_start`, of places at the start; `springs`: of
/// contact.
template <int D>
std::vector<std::string> names_of_columns(const Material& material, bool may_leave, bool forced,
                                          bool of_start, TransferId transfer, bool springs,
                                          bool in_body) {
  TileGrid<D> grid;
  grid.cell_size = 1.0;
  grid.outflow_box.exist = may_leave;
  ParticlePool<D> pool = make_pool(material, grid, columns_of(transfer, in_body));
  if (forced) add_force_column(pool);
  if (of_start) add_start_positions(pool);
  if (springs) add_set_back(pool);
  std::vector<std::string> names;
  for (const ColumnInfo& info : pool.columns.infos()) names.push_back(info.name);
  return names;
}

template <class M>
CatalogueModel described(const char* kind, const M& model) {
  CatalogueModel m{
      kind, std::string(model.name), std::string(model.doc), std::string(model.source), {}, {}, ""};
  for (const auto& p : model.params)
    m.parameters.push_back({std::string(p.name), std::string(p.unit), std::string(p.meaning),
                            p.rule,
                            std::isnan(p.start) ? std::nullopt : std::optional<double>(p.start)});
  if constexpr (requires { model.state_columns; })
    for (const auto& s : model.state_columns)
      m.state.push_back({std::string(s.name), std::string(s.unit)});
  if constexpr (requires { M::eos; })
    m.eos = M::eos == EosUse::never ? "never" : M::eos == EosUse::may ? "may" : "must";
  m.flows = requires { M::flows; };
  return m;
}

std::vector<CatalogueModel> catalogue() {
  std::vector<CatalogueModel> models;
  const auto add = [&](const char* kind) {
    return [&models, kind](const auto& model) { models.push_back(described(kind, model)); };
  };
  StrengthModels::for_each(add("strength"));
  EosModels::for_each(add("eos"));
  FailureModels::for_each(add("failure"));
  return models;
}

void add_drive(nb::module_& m) {
  m.def(
      "drive_material",
      [](double density, const std::string& strength, const Parameters& parameters,
         const std::optional<Named>& eos, const std::vector<NamedFailure>& failures,
         Viscosity viscosity, std::optional<bool> volume_averaging, const Input& increments,
         double time_step, double cell_size, const Parameters& state, bool lanes) {
        if (increments.ndim() != 3 || increments.shape(1) != 3 || increments.shape(2) != 3)
          throw std::invalid_argument("increments must have the shape (n, 3, 3)");
        DrivenPoint point =
            drive_material(choice_of(density, strength, parameters, eos, failures, viscosity, 0.0,
                                     volume_averaging),
                           {span_of(increments), time_step, cell_size, state, lanes});
        const std::size_t columns = point.names.size();
        return std::tuple(to_numpy(std::move(point.values), columns), point.names, point.units);
      },
      nb::arg("density"), nb::arg("strength"), nb::arg("parameters"), nb::arg("eos").none(),
      nb::arg("failures"), nb::arg("viscosity"), nb::arg("volume_averaging").none(),
      nb::arg("increments"), nb::arg("time_step"), nb::arg("cell_size"), nb::arg("state"),
      nb::arg("lanes"));
}

/// What matter a material is.
void add_matter(nb::module_& m) {
  m.def(
      "is_loose",
      [](double density, const std::string& strength, const Parameters& parameters,
         const std::optional<Named>& eos, const std::vector<NamedFailure>& failures,
         std::optional<bool> volume_averaging) {
        return make_material(choice_of(density, strength, parameters, eos, failures, {}, 0.0,
                                       volume_averaging))
            .is_loose();
      },
      nb::arg("density"), nb::arg("strength"), nb::arg("parameters"), nb::arg("eos").none(),
      nb::arg("failures"), nb::arg("volume_averaging").none(),
      "Whether neighbours among a material's particles are none for long: it flows, is loose or "
      "spalls");

  m.def(
      "matter",
      [](double density, const std::string& strength, const Parameters& parameters,
         const std::optional<Named>& eos) {
        const Material material =
            make_material(choice_of(density, strength, parameters, eos, {}, {}, 0.0, false));
        return matter_names[static_cast<std::size_t>(material.matter())];
      },
      nb::arg("density"), nb::arg("strength"), nb::arg("parameters"), nb::arg("eos").none(),
      "What bodies of a material are to others that touch them: \"solid\", \"liquid\" or \"gas\"");
}

}  // namespace

void add_materials(nb::module_& m) {
  nb::class_<CatalogueParameter>(m, "Parameter")
      .def_ro("name", &CatalogueParameter::name)
      .def_ro("unit", &CatalogueParameter::unit)
      .def_ro("meaning", &CatalogueParameter::meaning)
      .def_prop_ro("rule", [](const CatalogueParameter& p) { return p.rule.text(); })
      .def_prop_ro("bounds", [](const CatalogueParameter& p) { return bounds_of(p.rule); })
      .def_ro("default", &CatalogueParameter::start);
  nb::class_<CatalogueColumn>(m, "StateColumn")
      .def_ro("name", &CatalogueColumn::name)
      .def_ro("unit", &CatalogueColumn::unit);
  nb::class_<CatalogueModel>(m, "Model")
      .def_ro("kind", &CatalogueModel::kind)
      .def_ro("name", &CatalogueModel::name)
      .def_ro("doc", &CatalogueModel::doc)
      .def_ro("source", &CatalogueModel::source)
      .def_ro("parameters", &CatalogueModel::parameters)
      .def_ro("state", &CatalogueModel::state)
      .def_ro("eos", &CatalogueModel::eos)
      .def_ro("flows", &CatalogueModel::flows);
  m.def("catalogue", &catalogue);
  m.def(
      "column_names",
      [](int dimension, bool may_leave, bool forced, bool of_start, const std::string& transfer,
         bool springs, double density, const std::string& strength, const Parameters& parameters,
         const std::optional<Named>& eos, const std::vector<NamedFailure>& failures,
         Viscosity viscosity, double damping, std::optional<bool> volume_averaging, bool in_body) {
        const Material material =
            make_material(choice_of(density, strength, parameters, eos, failures, viscosity,
                                    damping, volume_averaging, in_body));
        const TransferId id = choice_named<TransferId>("transfer", transfer);
        return dimension == 2 ? names_of_columns<2>(material, may_leave, forced, of_start, id,
                                                    springs, in_body)
                              : names_of_columns<3>(material, may_leave, forced, of_start, id,
                                                    springs, in_body);
      },
      nb::arg("dimension"), nb::arg("may_leave"), nb::arg("forced"), nb::arg("of_start"),
      nb::arg("transfer"), nb::arg("springs"), nb::arg("density"), nb::arg("strength"),
      nb::arg("parameters"), nb::arg("eos").none(), nb::arg("failures"), nb::arg("viscosity"),
      nb::arg("damping"), nb::arg("volume_averaging").none(), nb::arg("in_body") = false,
      "The names of the columns that particles of a material have; `may_leave`: there is an "
      "outflow box, `forced`: a body force, which is a formula `of_start`, of places at the start; "
      "`springs`: of contact; `in_body`: of a body on nodes of its own");
  add_matter(m);
  add_drive(m);
}

}  // namespace mpm::bindings

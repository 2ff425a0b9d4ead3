// The settings of a case, the columns of its history and the fields of its frames, by name.
#include "mpm/run/settings.hpp"

#include <nanobind/stl/array.h>

#include "catalogue.hpp"
#include "mpm/ledger/history.hpp"
#include "mpm/math/expression.hpp"
#include "mpm/run/contact_rows.hpp"
#include "mpm/run/derived_fields.hpp"
#include "mpm/run/grain_rows.hpp"
#include "mpm/run/part_rows.hpp"
#include "mpm/surfaces/law.hpp"

namespace mpm::bindings {
namespace {

/// name -> what is to be known of it.
nb::dict all_bases() {
  nb::dict bases;
  Bases::for_each([&]<BasisModel B>(BasisId, const B&) {
    nb::dict known;
    known["doc"] = text(B::doc);
    known["source"] = text(B::source);
    known["nodes"] = B::nodes;
    known["before"] = B::before;
    known["own_node"] = B::own_node;
    known["second_moment"] = B::second_moment;
    bases[text(B::name)] = known;
  });
  return bases;
}

nb::dict all_transfers() {
  nb::dict transfers;
  Transfers::for_each([&]<TransferModel T>(TransferId, const T&) {
    nb::dict known;
    known["doc"] = text(T::doc);
    known["source"] = text(T::source);
    known["affine"] = T::affine;
    known["shares"] = T::has_share;
    known["filters"] = T::filters;
    transfers[text(T::name)] = known;
  });
  return transfers;
}

nb::dict all_history_terms() {
  nb::dict terms;
  for (const HistoryTerm& term : history_terms) {
    nb::dict row;
    row["unit"] = text(term.unit);
    row["meaning"] = text(term.meaning);
    row["role"] = text(word_of(term.role));
    row["part_of"] = text(term.part_of);
    terms[text(term.name)] = row;
  }
  return terms;
}

nb::dict described(std::span<const Column> rows) {
  nb::dict columns;
  for (const Column& column : rows)
    columns[text(column.name)] = nb::make_tuple(text(column.unit), text(column.meaning));
  return columns;
}

nb::dict all_derived_fields() {
  nb::dict fields;
  for (const DerivedField& field : derived_fields) {
    nb::dict row;
    row["unit"] = text(field.unit);
    row["meaning"] = text(field.meaning);
    row["constant"] = field.kept == Kept::once;
    row["on_request"] = field.kept == Kept::on_request;
    row["components"] = field.components;
    fields[text(field.name)] = row;
  }
  return fields;
}

nb::dict all_load_kinds() {
  nb::dict kinds;
  LoadKinds::for_each([&]<class Kind>(LoadKind, const Kind&) {
    nb::dict row;
    row["meaning"] = text(Kind::doc);
    row["vector"] = Kind::is_vector;
    row["at_point"] = acts_at_point<Kind>;
    row["unit"] = text(Kind::unit);
    kinds[text(Kind::name)] = row;
  });
  return kinds;
}

/// What formulas may do, and with how many numbers.
nb::dict all_operations() {
  nb::dict found;
  for (const Operation& operation : operations) found[text(operation.name)] = operation.operands;
  return found;
}

/// Of each stage: its name, what it reads and writes, and whether it goes through all particles.
nb::list stage_rows(const std::string& scheme, bool fused) {
  const auto names = [](std::uint64_t data) {
    nb::list said;
    for (std::size_t k = 0; k < data_names.size(); ++k)
      if (data >> k & 1u) said.append(text(data_names[k]));
    return said;
  };
  nb::list rows;
  for (const Stage<3>& stage : stages_of<3>(choice_named<Scheme>("scheme", scheme), fused))
    rows.append(nb::make_tuple(text(stage.name), names(stage.reads), names(stage.writes),
                               stage.all_particles));
  return rows;
}

std::array<std::string, 6> wall_words(const GridSettings& grid) {
  std::array<std::string, 6> found;
  for (std::size_t k = 0; k < found.size(); ++k) found[k] = word_of(grid.walls[k]);
  return found;
}

void set_walls(GridSettings& grid, const std::array<std::string, 6>& given) {
  for (std::size_t k = 0; k < given.size(); ++k)
    grid.walls[k] = choice_named<Wall>("a wall", given[k]);
}

/// What there is to choose from, and formulas.
void add_catalogues(nb::module_& m) {
  m.attr("walls") = words_of<Wall>();
  m.attr("failure_actions") = words_of<FailureAction>();
  m.attr("schemes") = words_of<Scheme>()[0];
  m.attr("bases") = all_bases();
  m.attr("transfers") = all_transfers();
  m.attr("history_terms") = all_history_terms();
  m.attr("most_cfl_of_surfaces") = most_cfl_of_springs;
  m.attr("part_columns") = described(part_columns);
  m.attr("grain_columns") = described(grain_columns);
  m.attr("contact_columns") = described(contact_columns);
  m.attr("total_columns") = described(total_columns);
  m.attr("load_kinds") = all_load_kinds();
  m.attr("derived_fields") = all_derived_fields();
  m.attr("operations") = all_operations();
  m.def(
      "evaluate",
      [](const Expression::Program& program, const std::vector<std::string>& names,
         const Input& values) {
        if (values.ndim() != 2) throw std::invalid_argument("values must be (variables, n)");
        return to_numpy(evaluate_rows(Expression(program), names, span_of(values), values.shape(1)),
                        1);
      },
      nb::arg("program"), nb::arg("names"), nb::arg("values"),
      "The values of a formula, (n, 1), of variables by their names, (variables, n)");
  m.def("stages", &stage_rows, nb::arg("scheme"), nb::arg("fused"),
        "Of each stage: its name, what it reads and writes, and whether it goes through all "
        "particles");
}

}  // namespace

void add_settings(nb::module_& m) {
  nb::class_<TimeFunction>(m, "TimeFunction")
      .def(nb::init_implicit<double>())
      .def(
          "__init__",
          [](TimeFunction* self, double constant, double amplitude, double frequency, double phase,
             const std::vector<double>& times, const std::vector<double>& values) {
            new (self) TimeFunction(constant);
            self->amplitude = amplitude;
            self->frequency = frequency;
            self->phase = phase;
            self->times = times;
            self->values = values;
          },
          nb::arg("constant"), nb::arg("amplitude"), nb::arg("frequency"), nb::arg("phase"),
          nb::arg("times"), nb::arg("values"))
      .def("at", &TimeFunction::at, nb::arg("time"))
      .def("mean", &TimeFunction::mean, nb::arg("start"), nb::arg("end"));

  nb::dict tables;
  add_table<CoarseningSettings>(m, "CoarseningSettings", tables);
  add_table<GridSettings>(m, "GridSettings", tables)
      .def_rw("origin", &GridSettings::origin)
      .def_rw("box_cells", &GridSettings::box_cells)
      .def_prop_rw("walls", &wall_words, &set_walls)
      .def_rw("wall_friction", &GridSettings::wall_friction)
      .def_rw("outflow", &GridSettings::outflow)
      .def_rw("outflow_lower", &GridSettings::outflow_lower)
      .def_rw("outflow_upper", &GridSettings::outflow_upper)
      .def_rw("coarsening", &GridSettings::coarsening, nb::arg("coarsening").none());
  add_table<TransferSettings>(m, "TransferSettings", tables)
      .def_prop_rw(
          "word", [](const TransferSettings& t) { return std::string(word_of(t.word)); },
          [](TransferSettings& t, const std::string& word) {
            t.word = choice_named<TransferId>("run.transfer", word);
          });
  add_table<SettleSettings>(m, "SettleSettings", tables);
  add_table<RunSettings>(m, "RunSettings", tables)
      .def_rw("transfer", &RunSettings::transfer)
      .def_rw("settle", &RunSettings::settle, nb::arg("settle").none());
  add_table<BulkViscosity>(m, "BulkViscosity", tables);
  add_table<ContactSettings>(m, "ContactSettings", tables);
  add_table<ExecutionSettings>(m, "ExecutionSettings", tables);
  nb::class_<Settings>(m, "Settings")
      .def(nb::init<>())
      .def_rw("grid", &Settings::grid)
      .def_rw("run", &Settings::run)
      .def_rw("contact", &Settings::contact)
      .def_rw("execution", &Settings::execution);

  m.attr("settings") = tables;
  add_catalogues(m);
}

}  // namespace mpm::bindings

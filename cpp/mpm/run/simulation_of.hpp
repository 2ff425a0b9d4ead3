#pragma once
// The simulation in D dimensions.
#include "mpm/run/simulation.hpp"
#include "mpm/run/timers.hpp"
#include "mpm/run/watch.hpp"

namespace mpm {

template <int D>
class SimulationOf final : public Simulation {
 public:
  explicit SimulationOf(const Settings& settings);

  int add_material(const MaterialChoice& choice) override;
  int add_body(const std::string& name, int material, std::span<const double> positions,
               std::span<const double> velocities, std::span<const double> volumes) override;
  void set_state(int body, const std::string& column, std::span<const double> values) override;
  void set_motion(int body, const std::array<TimeFunction, 3>& velocity,
                  const std::array<TimeFunction, 3>& spin,
                  const std::array<double, 3>& centre) override;
  void add_load(const std::string& name, int body, const std::string& kind,
                const std::array<TimeFunction, 3>& value, const Pieces& pieces) override;
  void set_group(int body, int first) override;
  void set_pair_friction(int a, int b, double mu) override;
  void prepare() override;
  std::int64_t advance(std::int64_t max_steps, double end_time,
                       const std::atomic<bool>* stop) override;

  void save(const StateStream::Transfer& to) override;
  void restore(const StateStream::Transfer& from, std::size_t size) override;

  double time() const override { return domain_.time; }
  double next_time_step() const override { return next_time_step_; }
  std::int64_t step() const override { return domain_.step; }
  int body_count() const override { return static_cast<int>(domain_.bodies.size()); }
  std::size_t particle_count(int body) const override { return this->body(body).count; }
  double total_mass() const override;
  GoneSum eroded() const override { return {domain_.eroded.mass, domain_.eroded.count}; }
  GoneSum left() const override { return {domain_.outflow.mass, domain_.outflow.count}; }
  std::vector<LoadRecord> loads() const override;
  const std::optional<Failure>& failure() const override { return failure_; }
  Limiter limiter() const override;
  std::vector<Warning> warnings() const override;
  Bytes bytes() const override;
  const std::vector<std::pair<std::string_view, double>>& stage_seconds() const override {
    return timers_.seconds();
  }
  void reset_timers() override { timers_.reset(); }
  void set_threads(int count) override { domain_.threads.resize(count); }

  const std::vector<ColumnInfo>& columns(int body) const override {
    return pool(this->body(body)).columns.infos();
  }
  int column_components(int body, const std::string& name) const override;
  void copy_column(int body, const std::string& name, std::span<double> to) const override;
  void round_column(const std::string& name, std::span<const int> places, std::size_t width,
                    std::span<float> to) const override;
  void round_derived(const std::string& name, std::span<float> to) const override;
  void set_gravity(const std::array<TimeFunction, 3>& gravity) override;
  void set_velocity(int body, std::span<const double> velocities) override;

  std::vector<double> take_history() override;
  const std::vector<PairRecord>& pairs() const override { return domain_.contact.records.all(); }
  std::vector<PairRecord> group_pairs() const override;
  std::size_t overlapped_nodes() const override { return domain_.contact.counts.overlapped; }
  std::size_t overlapped_nodes_max() const override {
    return domain_.contact.counts.overlapped_max;
  }
  int bodies_per_node_max() const override { return domain_.contact.counts.bodies_max; }
  std::size_t unconverged_nodes() const override { return domain_.contact.unconverged.load(); }

 private:
  const Body<D>& body(int b) const { return domain_.bodies.at(static_cast<std::size_t>(b)); }
  const ParticlePool<D>& pool(const Body<D>& b) const {
    return domain_.pools[static_cast<std::size_t>(b.material)];
  }
  void place_pieces();
  double kinetic_energy() const;
  std::array<double, 3> momentum() const;
  void start_motions();
  double initial_internal_energy() const;
  double wave_speed(const Body<D>& b, std::size_t row) const;
  void probe_speeds();  // finds the next time step from the present state
  void make_step(double time_after);
  void choose_time_step();
  bool must_coarsen() const;
  int most_coarsenings() const {
    return settings_.grid.coarsening ? settings_.grid.coarsening->times : 0;
  }
  void coarsen_cells();
  void write_history_row();
  void exchange(StateStream& stream);
  /// f(pool, row) for the particles that take part, in the order of the lists.
  template <class F>
  void for_each_particle(F&& f) const {
    for (const Patch<D>& patch : domain_.grid.patches) {
      const ParticlePool<D>& of = pool(body(patch.body));
      for (const std::uint32_t row : of.rows(patch)) f(of, row);
    }
  }
  void check_lists() const;
  void check_ranges() const;
  void check_rows() const;
  void check_pieces() const;
  void check_rest(double cell_size, const Index<D>& walls) const;
  void find_failure();
  void watch_step();
  void watch_crowd();
  void look();
  void judge();
  void note(Note found);
  std::string group_name(int first) const;
  void note_at(Note found, int b, std::size_t row);
  std::size_t row_of(int b, std::int64_t particle) const;
  Failure failure_at(const std::string& kind, std::size_t body, std::size_t row,
                     const std::string& what) const;

  Settings settings_;
  Domain<D> domain_;
  std::span<const Stage<D>> stages_;
  StageTimers timers_;
  double next_time_step_ = 0.0;
  int coarsenings_ = 0;  // of the cells so far
  bool prepared_ = false;
  std::optional<Failure> failure_;
  static constexpr std::int64_t look_every = 64;  // steps
  /// Particles of a group that something is true of, and the one of which it is most so.
  struct Seen {
    std::size_t count = 0, body = 0, row = 0;
    double most = 0.0, value = 0.0;
    void add(std::size_t b, std::size_t at, double size, double shown) {
      if (count++ == 0 || size > most) {
        most = size;
        body = b;
        row = at;
        value = shown;
      }
    }
  };
  struct Sight {
    std::size_t particles = 0;
    Seen outside, odd, left[2 * D];
  };
  StepWatch watch_;
  std::int64_t looked_ = -1;  // step of the last look
  std::vector<Note> notes_;
  std::vector<Sight> sights_;    // scratch, one per body
  std::vector<double> history_;  // rows not yet taken; room for history_capacity is made once
};

extern template class SimulationOf<2>;
extern template class SimulationOf<3>;

}  // namespace mpm

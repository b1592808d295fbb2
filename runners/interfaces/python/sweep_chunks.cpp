// Sweeps whose runs are done by the workers of an executor: chunks of runs in a worker, and the file in the
// process that submits them.
#include <malloc.h>
#include <omp.h>
#include <pybind11/stl.h>

#include <optional>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/sweep_arrays.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

template <class Number>
using Array = py::array_t<Number, py::array::c_style | py::array::forcecast>;
using Texts = std::vector<std::string>;

// Parallel loops of the calling thread have one thread as long as this exists: a worker has one processor,
// and a forked one has lost the threads that OpenMP knows.
class OneThread {
 public:
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  const int before_ = omp_get_max_threads();
};

TextAttributes this_build() {
  return build_of(provenance("", "", ""));
}

// A sweep in a worker. Any number of threads may use it.
class WorkerSweep {
 public:
  explicit WorkerSweep(const std::string& config) {
    const py::gil_scoped_release without_lock;
    const OneThread one_thread;
    // Runs then do not return memory to the system and get it back each time, see program.cpp.
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    sweep_.emplace(Sweep::from_json(config, "config"));
    inputs_ = input_hashes(sweep_->inputs());
  }
  const std::string& inputs() const { return inputs_; }

  // Returns the states, values (measures x runs), notes and errors of the runs with these numbers.
  py::tuple do_runs(const Array<std::uint64_t>& runs) const {
    std::vector<std::uint64_t> numbers(runs.data(), runs.data() + runs.size());
    SweepResult part;
    std::vector<double> values;
    std::vector<std::int32_t> states;
    {
      const UnchangedCatalog unchanged;
      const py::gil_scoped_release without_lock;
      const OneThread one_thread;
      part = sweep_->part(std::move(numbers));
      SweepRunOptions options;
      options.kernels = &chosen_python_kernels();
      options.runs = [](std::size_t count, const auto& work) {
        for (std::size_t i = 0; i < count; ++i) work(i);
      };
      if (do_pending_runs(*sweep_, part, options) > 0) throw std::bad_alloc();
      for (const Column& measure : part.measures) {
        const auto& of_measure = std::get<std::vector<double>>(measure.values);
        values.insert(values.end(), of_measure.begin(), of_measure.end());
      }
      for (const RunState state : part.state) states.push_back(static_cast<std::int32_t>(state));
    }
    const auto rows = static_cast<py::ssize_t>(part.measures.size());
    const auto columns = runs.size();
    return py::make_tuple(owning_array(std::move(states), {columns}),
                          owning_array(std::move(values), {rows, columns}),
                          owning_array(std::move(part.notes), {columns}), part.error);
  }

 private:
  std::optional<Sweep> sweep_;
  std::string inputs_;
};

// Puts the outcomes of a chunk into the result, and calls stored with each place. Throws InputError for a
// chunk that no worker of this build makes.
void store(SweepResult& result, const std::function<void(std::size_t)>& stored,
           const Array<std::uint64_t>& runs, const Array<std::int32_t>& states, const Array<double>& values,
           const Array<std::uint64_t>& notes, const Texts& errors) {
  const py::ssize_t count = runs.size();
  bool fits = states.size() == count && notes.size() == count && values.ndim() == 2 &&
              values.shape(0) == static_cast<py::ssize_t>(result.measures.size()) &&
              values.shape(1) == count && errors.size() == static_cast<std::size_t>(count);
  std::vector<std::size_t> places;
  for (py::ssize_t i = 0; fits && i < count; ++i) {
    const auto state = static_cast<RunState>(states.data()[i]);
    const auto place = result.place_of(runs.data()[i]);
    fits = place && *place < result.state.size() && result.state[*place] == RunState::pending &&
           (state == RunState::done || state == RunState::failed) &&
           SweepResult::are_known_notes(notes.data()[i], result.note_kinds.size());
    if (fits) places.push_back(*place);
  }
  if (!fits)
    throw InputError("a chunk", "damaged: expected an outcome for each of its runs, the first of which is " +
                                    std::to_string(count > 0 ? runs.data()[0] : 0) +
                                    "; none of them is stored, and the same call makes them again");
  for (py::ssize_t i = 0; i < count; ++i) {
    const std::size_t place = places[static_cast<std::size_t>(i)];
    for (std::size_t m = 0; m < result.measures.size(); ++m)
      std::get<std::vector<double>>(result.measures[m].values)[place] =
          values.at(static_cast<py::ssize_t>(m), i);
    result.notes[place] = notes.data()[i];
    result.error[place] = printable(errors[static_cast<std::size_t>(i)]);
    result.state[place] = static_cast<RunState>(states.data()[i]);
    stored(place);
  }
}

// A sweep whose runs others do, by calls of a function in Python, do_round(config, inputs, pending, done,
// total, is_tally, store, forget), on this thread, so that Ctrl-C arrives in it. pending: the numbers of the
// runs to do. done, total: the number of finished runs, now and in the end. is_tally: earlier runs cannot be
// forgotten, because they are added up. store, forget: see store() and SweepSession::forget().
struct WorkElsewhere {
  const Sweep& sweep;
  const std::string inputs;
  const py::function& do_round;

  void operator()(
      SweepResult& result, std::size_t done, std::size_t total,
      const std::function<void(std::size_t)>& stored,
      const std::function<void(const std::vector<std::size_t>&, const std::string&)>& forget) const {
    const py::gil_scoped_acquire lock;
    std::vector<std::uint64_t> pending;
    for (const std::size_t place : result.runs_in(RunState::pending)) pending.push_back(result.run_at(place));
    const auto count = static_cast<py::ssize_t>(pending.size());
    do_round(py::bytes(sweep.to_json()), inputs, owning_array(std::move(pending), {count}), done, total,
             sweep.keep() != Keep::runs,
             py::cpp_function(
                 [&](const Array<std::uint64_t>& runs, const Array<std::int32_t>& states,
                     const Array<double>& values, const Array<std::uint64_t>& notes,
                     const Texts& errors) { store(result, stored, runs, states, values, notes, errors); }),
             py::cpp_function(
                 [&](const std::vector<std::size_t>& runs, const std::string& why) { forget(runs, why); }));
  }
};

SweepResult runs_elsewhere(SweepSession session, const WorkElsewhere& work) {
  const auto do_runs = [&](SweepResult& result, const std::function<void(std::size_t)>& stored) {
    const std::size_t done = result.runs_in(RunState::done).size();
    work(result, done, done + result.runs_in(RunState::pending).size(), stored,
         [&](const std::vector<std::size_t>& runs, const std::string&) { session.forget(runs); });
    return std::size_t{0};
  };
  session.run(do_runs, [](auto...) {});
  return session.result();
}

// A batch of a tally takes half a minute, because the workers wait for each other at its end.
StoredTally tally_elsewhere(TallySession session, const WorkElsewhere& work) {
  constexpr double kBatch_s = 30;
  const auto do_batch = [&](SweepResult& batch) {
    const auto forget = [&](const std::vector<std::size_t>& runs, const std::string& why) {
      for (const std::size_t run : runs)
        if (const auto place = batch.place_of(run)) batch.state[*place] = RunState::pending;
      if (!why.empty()) session.distrust(why);
    };
    work(
        batch, session.tally().held.count(), session.own_runs(), [](std::size_t) {}, forget);
  };
  session.run(do_batch, kBatch_s, [](auto...) {});
  return {session.tally(), session.attributes()};
}

py::dict sweep_in_chunks(const std::string& subject, const std::optional<std::string>& text,
                         const Texts& overrides, const std::string& output, const py::function& do_round) {
  StoredSweep all;
  std::optional<StoredTally> tally;
  {
    const UnchangedCatalog unchanged;
    const py::gil_scoped_release without_lock;
    const Sweep sweep = text ? Sweep::from_json(*text, subject, overrides) : Sweep::load(subject, overrides);
    const WorkElsewhere work{sweep, input_hashes(sweep.inputs()), do_round};
    all.attributes = provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", work.inputs);
    require_writable(output);
    const FileTurn turn(FileTurn::For::a_sweep);
    if (sweep.keep() == Keep::runs)
      all.result = runs_elsewhere(SweepSession(sweep, Shard{}, all.attributes, output), work);
    else
      tally = tally_elsewhere(TallySession(sweep, Shard{}, all.attributes, output), work);
  }
  return tally ? to_python(*tally) : to_python(std::move(all));
}

}  // namespace

void bind_chunks(py::module_& module) {
  py::class_<WorkerSweep>(module, "WorkerSweep", "A sweep in a worker of an executor.")
      .def(py::init<const std::string&>(), py::arg("config"))
      .def_property_readonly("inputs", &WorkerSweep::inputs)
      .def("do_runs", &WorkerSweep::do_runs, py::arg("runs"));
  module.def(
      "build", [] { return to_python(this_build()); }, "The attributes that are equal in runs of one file.");
  module.def("sweep_in_chunks", &sweep_in_chunks, py::arg("subject"), py::arg("text"), py::arg("overrides"),
             py::arg("output"), py::arg("do_round"), "Does a sweep whose runs others do, into a file.");
}

}  // namespace remote_touch

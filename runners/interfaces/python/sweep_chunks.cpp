// Sweeps whose runs are done by the workers of an executor: chunks of runs in a worker, and the file in the
// process that submits them.
#include <malloc.h>
#include <omp.h>
#include <pybind11/stl.h>

#include <optional>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/interfaces/python/sweep_arrays.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_origin.h"
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

// Puts the outcomes of a chunk into the result. Throws InputError for one that no worker of this build makes.
void store(SweepResult& result, const std::function<void(std::size_t)>& stored,
           const Array<std::uint64_t>& runs, const Array<std::int32_t>& states, const Array<double>& values,
           const Array<std::int32_t>& notes, const Texts& errors) {
  const py::ssize_t count = runs.size();
  bool fits = states.size() == count && notes.size() == count && values.ndim() == 2 &&
              values.shape(0) == static_cast<py::ssize_t>(result.measures.size()) &&
              values.shape(1) == count && errors.size() == static_cast<std::size_t>(count);
  for (py::ssize_t i = 0; fits && i < count; ++i) {
    const auto state = static_cast<RunState>(states.data()[i]);
    fits = runs.data()[i] < result.state.size() && result.state[runs.data()[i]] == RunState::pending &&
           (state == RunState::done || state == RunState::failed) && notes.data()[i] >= 0 &&
           notes.data()[i] >> result.note_kinds.size() == 0;
  }
  if (!fits) throw InputError("a chunk", "damaged: expected an outcome for each of its runs");
  for (py::ssize_t i = 0; i < count; ++i) {
    const std::size_t place = runs.data()[i];
    for (std::size_t m = 0; m < result.measures.size(); ++m)
      std::get<std::vector<double>>(result.measures[m].values)[place] =
          values.at(static_cast<py::ssize_t>(m), i);
    result.notes[place] = notes.data()[i];
    result.error[place] = errors[static_cast<std::size_t>(i)];
    result.state[place] = static_cast<RunState>(states.data()[i]);
    stored(place);
  }
}

// Does a sweep by calls of do_round(config, inputs, pending, done, store, forget), a function in Python: one
// call for each round, on this thread, so that Ctrl-C arrives in it.
py::dict sweep_in_chunks(const std::string& subject, const std::optional<std::string>& text,
                         const Texts& overrides, const std::string& output, const py::function& do_round) {
  StoredSweep all;
  {
    const py::gil_scoped_release without_lock;
    const Sweep sweep = text ? Sweep::from_json(*text, subject, overrides) : Sweep::load(subject, overrides);
    const std::string inputs = input_hashes(sweep.inputs());
    all.attributes = provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", inputs);
    require_writable(output);
    const FileTurn turn(FileTurn::For::a_sweep);
    SweepSession session(sweep, Shard{}, all.attributes, output);
    const auto do_runs = [&](SweepResult& result, const std::function<void(std::size_t)>& stored) {
      const py::gil_scoped_acquire lock;
      const std::vector<std::size_t> pending = result.runs_in(RunState::pending);
      do_round(py::bytes(sweep.to_json()), inputs,
               owning_array(std::vector<std::uint64_t>(pending.begin(), pending.end()),
                            {static_cast<py::ssize_t>(pending.size())}),
               result.runs_in(RunState::done).size(),
               py::cpp_function(
                   [&](const Array<std::uint64_t>& runs, const Array<std::int32_t>& states,
                       const Array<double>& values, const Array<std::int32_t>& notes,
                       const Texts& errors) { store(result, stored, runs, states, values, notes, errors); }),
               py::cpp_function([&](const std::vector<std::size_t>& runs) { session.forget(runs); }));
      return std::size_t{0};
    };
    session.run(do_runs, [](auto...) {});
    all.result = session.result();
  }
  return to_python(std::move(all));
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

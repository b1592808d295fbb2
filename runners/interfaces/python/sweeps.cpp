#include <malloc.h>
#include <omp.h>
#include <pybind11/stl.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {

// Runs a sweep, in memory or into a file, and analyses it.

namespace py = pybind11;

namespace {

SweepResult in_memory(const Sweep& sweep, const LongWork& work) {
  SweepResult result = sweep.plan();
  std::size_t done = 0;
  SweepRunOptions options;
  options.kernels = &work.kernels, options.stop = &work.stop;
  do {
    const std::size_t all = result.runs_in(RunState::pending).size() + done;
    options.finished = [&](std::size_t) {
      work.progress(static_cast<double>(++done) / static_cast<double>(all));
    };
    if (do_pending_runs(sweep, result, options) > 0) throw std::bad_alloc();
  } while (add_round(sweep, result));
  return result;
}

KeptSweep in_file(const Sweep& sweep, const TextAttributes& origin, const std::string& file,
                  const LongWork& work) {
  require_writable(file);
  const FileTurn turn(FileTurn::For::a_sweep);
  SweepSession session(sweep, Shard{}, origin, file);
  session.run(work.kernels, &work.stop, [&](std::size_t done, std::size_t all, std::size_t) {
    work.progress(static_cast<double>(done) / static_cast<double>(all));
  });
  return session.kept();
}

py::dict run_sweep_of(const std::string& subject, const std::optional<std::string>& text,
                      const std::vector<std::string>& overrides, int threads, const std::string& output,
                      const py::object& report) {
  KeptSweep made;
  do_long_work(report, threads, [&](const LongWork& work) {
    const Sweep sweep = sweep_of(subject, text, overrides);
    if (output.empty() && sweep.keep() != Keep::runs)
      throw InputError(sweep.title(), "keeps a tally: expected an output, which the runs are added to");
    const TextAttributes origin =
        provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", input_hashes(sweep.inputs()));
    made = output.empty() ? KeptSweep{in_memory(sweep, work), origin} : in_file(sweep, origin, output, work);
  });
  return to_python(std::move(made));
}

// parts: axes and measures as lists of columns, the states of the runs, the number of replicates, and the
// notes on the runs, which may be missing.
SweepResult result_of(const py::tuple& parts) {
  SweepResult result;
  for (const py::handle& axis : parts[0]) result.axes.push_back(column_of(axis));
  for (const py::handle& measure : parts[1]) result.measures.push_back(column_of(measure));
  for (const auto state : parts[2].cast<std::vector<std::int32_t>>())
    result.state.push_back(static_cast<RunState>(state));
  result.replicates = parts[3].cast<int>();
  result.notes = parts[4].cast<std::vector<std::uint64_t>>();
  bool fits = result.state.size() == result.run_count() &&
              (result.notes.empty() || result.notes.size() == result.run_count());
  for (const Column& measure : result.measures)
    fits &=
        measure.length() == result.run_count() && std::holds_alternative<std::vector<double>>(measure.values);
  if (!fits) throw InputError("the data set", "expected what rt.sweep returned");
  return result;
}

// file: of a sweep, or empty for one in memory, which has parts and a configuration.
py::dict analyse(const std::string& file, const py::tuple& parts, const std::string& config,
                 const SweepQuestion& question) {
  Figure answer;
  std::string warning;
  if (file.empty()) {
    const SweepResult result = result_of(parts);
    const py::gil_scoped_release without_lock;
    answer = sweep_answer(result, config, question);
  } else {
    const py::gil_scoped_release without_lock;
    const FileTurn turn;
    const KeptSweep stored = read_kept_sweep(file, Extent::whole);
    const std::string stored_config = attribute(stored.attributes, "config");
    warning = stored.warning;
    answer = std::visit([&](const auto& kept) { return sweep_answer(kept, stored_config, question); },
                        stored.kept);
  }
  std::vector<Column> columns;
  for (const Table& table : answer.tables) {
    if (is_of_curve(answer, table)) continue;
    for (Column column : table.columns) {
      column.name = table.name + "/" + column.name;
      columns.push_back(std::move(column));
    }
  }
  py::dict all;
  all["columns"] = to_python(std::move(columns));
  all["attributes"] = to_python(TextAttributes{{"title", answer.title}, {"caption", answer.caption}});
  all["warning"] = warning;
  return all;
}

}  // namespace

void bind_sweeps(py::module_& module) {
  module.def("sweep", &run_sweep_of, py::arg("subject"), py::arg("text"), py::arg("overrides"),
             py::arg("threads"), py::arg("output"), py::arg("report"),
             "Runs a sweep: axes, and measures over them.");
  using Names = std::vector<std::string>;
  module.def(
      "analyse",
      [](const std::string& file, const py::tuple& parts, const std::string& config, const std::string& limit,
         const std::string& along, double above, double level, const Names& mean, const Names& by,
         const Names& difference, const std::string& between, const std::string& direction) {
        return analyse(file, parts, config,
                       {limit, along, above, level, mean, by, difference, between, direction});
      },
      py::arg("file"), py::arg("parts"), py::arg("config"), py::arg("limit"), py::arg("along"),
      py::arg("above"), py::arg("level"), py::arg("mean"), py::arg("by"), py::arg("difference"),
      py::arg("between"), py::arg("direction"), "Limits, means and differences of a sweep, as tables.");
}

namespace {

// Sweeps whose runs are done by the workers of an executor: chunks of runs in a worker, and the file in the
// process that submits them.

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

  void operator()(SweepSession& session, SweepResult& runs,
                  const std::function<void(std::size_t)>& stored) const {
    const py::gil_scoped_acquire lock;
    std::vector<std::uint64_t> pending;
    for (const std::size_t place : runs.runs_in(RunState::pending)) pending.push_back(runs.run_at(place));
    const auto count = static_cast<py::ssize_t>(pending.size());
    do_round(py::bytes(sweep.to_json()), inputs, owning_array(std::move(pending), {count}), session.done(),
             session.total(), sweep.keep() != Keep::runs,
             py::cpp_function(
                 [&](const Array<std::uint64_t>& numbers, const Array<std::int32_t>& states,
                     const Array<double>& values, const Array<std::uint64_t>& notes,
                     const Texts& errors) { store(runs, stored, numbers, states, values, notes, errors); }),
             py::cpp_function([&](const std::vector<std::size_t>& wrong, const std::string& why) {
               session.forget(wrong, why);
             }));
  }
};

KeptSweep done_elsewhere(SweepSession session, const WorkElsewhere& work) {
  constexpr double kBatch_s = 30;  // the workers wait for each other at the end of a batch of a tally
  const auto do_runs = [&](SweepResult& runs, const std::function<void(std::size_t)>& stored) {
    work(session, runs, stored);
    return std::size_t{0};
  };
  session.run(do_runs, kBatch_s, [](auto...) {});
  return session.kept();
}

py::dict sweep_in_chunks(const std::string& subject, const std::optional<std::string>& text,
                         const Texts& overrides, const std::string& output, const py::function& do_round) {
  KeptSweep made;
  {
    const UnchangedCatalog unchanged;
    const py::gil_scoped_release without_lock;
    const Sweep sweep = sweep_of(subject, text, overrides);
    const WorkElsewhere work{sweep, input_hashes(sweep.inputs()), do_round};
    const TextAttributes origin =
        provenance(sweep.to_json(), Recipe{"sweep", subject, overrides}, "", work.inputs);
    require_writable(output);
    const FileTurn turn(FileTurn::For::a_sweep);
    made = done_elsewhere(SweepSession(sweep, Shard{}, origin, output), work);
  }
  return to_python(std::move(made));
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

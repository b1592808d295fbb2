#include "runners/experiment/opencl/built_kernels.h"

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "runners/experiment/opencl/kernel_source.h"

namespace remote_touch {

namespace {

std::string options(const OpenClDevice& device, const DepthPipelineSettings& settings) {
  std::string text = "-cl-std=CL1.2 -D FILTER_HALF=" + std::to_string(settings.filter_window / 2) +
                     " -D NORMAL_HALF=" + std::to_string(settings.normal_window / 2);
  text += device.rounds_division ? " -cl-fp32-correctly-rounded-divide-sqrt" : " -D DIVIDE_IN_DOUBLE";
  return text;
}

// `mutex` is not locked while kernels are built or released. The kernels of one platform are built one after
// another, by threads with a deadline: not all compilers in drivers are safe in two threads, and the second
// thread may find its kernels already built. A driver that hangs does not delay other platforms.
struct Cache {
  using Key = std::pair<cl_device_id, std::string>;
  std::mutex mutex;
  std::map<Key, std::shared_ptr<const BuiltKernels>> built;
  std::map<int, std::mutex> one_at_a_time;  // one mutex for each platform

  std::mutex& turn_of(int platform) {
    const std::lock_guard lock(mutex);
    return one_at_a_time[platform];
  }
};

Cache& cache() {
  // The cache is never freed, because the driver may be unloaded earlier at the end of the process.
  static Cache& one = *new Cache;
  return one;
}

}  // namespace

BuiltKernels::BuiltKernels(const OpenClLibrary& library, const OpenClDevice& device,
                           const DepthPipelineSettings& settings)
    : cl_(library), device_(device.id) {
  cl_int code = CL_SUCCESS;
  context_ = {cl_.CreateContext(nullptr, 1, &device_, nullptr, nullptr, &code), cl_.ReleaseContext};
  require(code, "clCreateContext");
  const char* source = kDepthKernelSource;
  program_ = {cl_.CreateProgramWithSource(context_.get(), 1, &source, nullptr, &code), cl_.ReleaseProgram};
  require(code, "clCreateProgramWithSource");
  code = cl_.BuildProgram(program_.get(), 1, &device_, options(device, settings).c_str(), nullptr, nullptr);
  if (code != CL_BUILD_PROGRAM_FAILURE) {
    require(code, "clBuildProgram");
    return;
  }
  std::string log(4096, '\0');
  std::size_t bytes = 0;
  cl_.GetProgramBuildInfo(program_.get(), device_, CL_PROGRAM_BUILD_LOG, log.size(), log.data(), &bytes);
  throw OpenClError("clBuildProgram: " + log.substr(0, log.find_first_of(std::string("\n\0", 2))));
}

BuiltKernels::Kernel BuiltKernels::kernel(const char* name) const {
  cl_int code = CL_SUCCESS;
  Kernel made{cl_.CreateKernel(program_.get(), name, &code), cl_.ReleaseKernel};
  require(code, "clCreateKernel");
  return made;
}

std::shared_ptr<const BuiltKernels> built_kernels(const OpenClLibrary& library, const OpenClDevice& device,
                                                  const DepthPipelineSettings& settings) {
  Cache& all = cache();
  const Cache::Key key{device.id, options(device, settings)};
  const std::lock_guard alone(all.turn_of(device.platform));
  {
    const std::lock_guard lock(all.mutex);
    if (const auto known = all.built.find(key); known != all.built.end()) return known->second;
  }
  auto made = std::make_shared<const BuiltKernels>(library, device, settings);
  const std::lock_guard lock(all.mutex);
  return all.built.emplace(key, std::move(made)).first->second;
}

std::vector<std::shared_ptr<const BuiltKernels>> forget_kernels(cl_device_id device) {
  std::vector<std::shared_ptr<const BuiltKernels>> forgotten;
  const std::lock_guard lock(cache().mutex);
  for (auto& [key, built] : cache().built)
    if (key.first == device) forgotten.push_back(std::move(built));
  std::erase_if(cache().built, [&](const auto& entry) { return entry.first.first == device; });
  return forgotten;
}

}  // namespace remote_touch

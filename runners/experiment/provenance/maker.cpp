#include "runners/experiment/provenance/maker.h"

#include "runners/experiment/provenance/provenance.h"

namespace remote_touch {

std::string other_maker(const TextAttributes& result) {
  const std::string program = attribute(result, "program"), plugins = attribute(result, "plugins");
  if (!program.empty() && program != program_identity().name)
    return "was made by " + program + ", which has entries of its own: expected that program";
  if (!plugins.empty() && program_identity().plugins.empty())
    return "was made with plug-ins: expected --plugin for each of\n" + plugins;
  return {};
}

}  // namespace remote_touch

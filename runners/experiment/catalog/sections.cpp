#include "runners/experiment/catalog/configuration.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

using Configuration = ExperimentConfiguration;

// Returns the value of a section; null if it is missing.
const Json& given(const Json& whole, const std::string& key) {
  static const Json kAbsent;
  const auto found = whole.find(key);
  return found == whole.end() ? kAbsent : *found;
}

// --- settings of one kind ---

template <class Settings>
class OwnedSettings final : public Configurable {
 public:
  Parameters settings() override { return parameters(values_); }
  std::string validate() const override { return remote_touch::validate(values_); }

 private:
  Settings values_;
};

template <class Settings>
std::vector<SectionEntry> one_entry() {
  return {{"", "", [] { return std::make_unique<OwnedSettings<Settings>>(); }}};
}

template <class Settings>
Settings read_settings(const Json& json, const std::string& path) {
  if (!json.is_object())
    throw InputError(path, "expected an object of parameters; leave the section out otherwise");
  Settings settings;
  read_parameters(json, parameters(settings), path);
  const std::string problem = validate(settings);
  if (!problem.empty()) throw InputError(path + "." + problem);
  return settings;
}

template <class Settings>
Json settings_json(Settings settings) {
  Json json = Json::object();
  write_parameters(parameters(settings), json);
  return json;
}

// --- settings of an entry of a catalog ---

template <class Entry>
std::vector<SectionEntry> catalog_entries(std::span<const Entry> catalog) {
  std::vector<SectionEntry> entries;
  for (const Entry& entry : catalog) entries.push_back({entry.name, entry.summary, entry.make});
  return entries;
}

template <class Entry>
Part<Entry> read_part(const Json& json, std::span<const Entry> catalog, const std::string& path) {
  if (json.is_object() && json.contains("name") && !json["name"].is_string())
    throw InputError(path + ".name = " + shown(json["name"]), "expected a name from `remote-touch list`");
  if (json.is_string())
    throw InputError(path + " = " + shown(json), "not an object: expected {\"name\": " + shown(json) +
                                                     "}, with parameters beside the name");
  if (!json.is_null() && !json.is_object())
    throw InputError(path + " = " + shown(json), "not an object: expected {\"name\": ..., parameters}");
  if (!json.is_object() || !json.contains("name"))
    throw InputError(path, "missing: expected {\"name\": ..., parameters}");
  Part<Entry> part;
  part.name = json["name"].template get<std::string>();
  part.factory = find_entry(catalog, part.name, path + ".name").make();
  read_parameters(json, part.factory->settings(), path, {"name"});
  const std::string problem = part.factory->validate();
  if (!problem.empty()) throw InputError(path + "." + problem);
  return part;
}

template <class Entry>
Json part_json(const Part<Entry>& part) {
  Json json = {{"name", part.name}};
  write_parameters(part.factory->settings(), json);
  return json;
}

template <class Entry>
void add_part_inputs(const Part<Entry>& part, std::vector<InputPart>& inputs) {
  const std::vector<InputPart> own = part.factory->inputs();
  inputs.insert(inputs.end(), own.begin(), own.end());
}

// --- lists ---

// Reads a list; a missing list is empty. first: name of the first key of an element, for the message.
// read_one(json, path) returns an element.
template <class Element, class ReadOne>
std::vector<Element> read_list(const Json& list, const std::string& key, const std::string& first,
                               ReadOne read_one) {
  std::vector<Element> elements;
  if (list.is_null()) return elements;
  if (!list.is_array()) throw InputError(key, "expected a list of {\"" + first + "\": ..., parameters}");
  for (std::size_t i = 0; i < list.size(); ++i)
    elements.push_back(read_one(list[i], key + "." + std::to_string(i)));
  return elements;
}

template <class Element, class WriteOne>
Json list_json(const std::vector<Element>& elements, WriteOne write_one) {
  Json list = Json::array();
  for (const Element& element : elements) list.push_back(write_one(element));
  return list;
}

// --- the kinds of sections ---

using Section = ExperimentSection;
using Rule = void (*)(Configuration&);

template <auto kMember>
using Member = std::remove_cvref_t<decltype(std::declval<Configuration>().*kMember)>;

bool has(const Parameters& parameters, const std::string& name) {
  return std::ranges::any_of(parameters, [&](const Parameter& p) { return p.name == name; });
}

// True if the section, as it is in the configuration, has a parameter of that name.
bool has(const Section& section, const Json& whole, const std::string& parameter) {
  const Json& own = given(whole, section.key);
  if (!own.is_object()) return false;
  for (const SectionEntry& entry : section.entries())
    if (entry.name.empty() || own.value("name", Json()) == entry.name)
      if (has(entry.make()->settings(), parameter)) return true;
  return false;
}

// True if the JSON of a section names one of its entries.
bool has_known_name(const Section& section, const Json& own) {
  if (!own.is_object()) return false;
  const Json name = own.value("name", Json());
  const std::vector<SectionEntry> entries = section.entries();
  return name.is_string() &&
         std::ranges::any_of(entries, [&](const SectionEntry& entry) { return name == entry.name; });
}

// Throws InputError for a key at the top level that is a parameter of a section in this configuration. The
// message names that section.
void refuse_misplaced(const Json& whole, const Parameters& own, const std::vector<std::string>& sections) {
  for (const auto& item : whole.items()) {
    const bool is_section = std::ranges::find(sections, item.key()) != sections.end();
    if (is_section || has(own, item.key())) continue;
    for (const Section& section : experiment_sections())
      if (!section.is_top_level && has(section, whole, item.key()))
        throw InputError(item.key(), std::string("unknown; did you mean ") + section.key + "." + item.key());
  }
}

// Parameters at the level of the sections. A key that is neither a section nor one of them is unknown.
template <auto kMember>
Section top_level(const char* key, const char* summary) {
  Section s{key, summary};
  s.is_top_level = true;
  s.entries = one_entry<Member<kMember>>;
  s.read = [](const Section&, const Json& whole, Configuration& configuration) {
    std::vector<std::string> sections;
    for (const Section& section : experiment_sections())
      if (!section.is_top_level) sections.push_back(section.key);
    refuse_misplaced(whole, parameters(configuration.*kMember), sections);
    read_parameters(whole, parameters(configuration.*kMember), "", sections);
  };
  s.write = [](const Section&, const Configuration& configuration, Json& whole) {
    Member<kMember> settings = configuration.*kMember;
    write_parameters(parameters(settings), whole);
  };
  return s;
}

// An entry of a catalog, {"name": ..., parameters}. It is required.
template <auto kMember, auto kCatalog>
Section required(const char* key, const char* heading, const char* summary) {
  Section s{key, summary, heading};
  s.entries = [] { return catalog_entries(kCatalog()); };
  s.read = [](const Section& section, const Json& whole, Configuration& configuration) {
    configuration.*kMember = read_part(given(whole, section.key), kCatalog(), section.key);
  };
  s.write = [](const Section& section, const Configuration& configuration, Json& whole) {
    whole[section.key] = part_json(configuration.*kMember);
  };
  s.add_inputs = [](const Configuration& configuration, std::vector<InputPart>& inputs) {
    add_part_inputs(configuration.*kMember, inputs);
  };
  return s;
}

// A list of entries of a catalog. It is empty if it is left out.
template <auto kMember, auto kCatalog>
Section list_of_entries(const char* key, const char* heading, const char* summary, Rule complete = nullptr) {
  using Element = typename Member<kMember>::value_type;
  Section s{key, summary, heading};
  s.entries = [] { return catalog_entries(kCatalog()); };
  s.read = [](const Section& section, const Json& whole, Configuration& configuration) {
    configuration.*kMember = read_list<Element>(
        given(whole, section.key), section.key, "name",
        [](const Json& json, const std::string& path) { return read_part(json, kCatalog(), path); });
  };
  s.write = [](const Section& section, const Configuration& configuration, Json& whole) {
    whole[section.key] =
        list_json(configuration.*kMember, [](const Element& part) { return part_json(part); });
  };
  s.add_inputs = [](const Configuration& configuration, std::vector<InputPart>& inputs) {
    for (const Element& part : configuration.*kMember) add_part_inputs(part, inputs);
  };
  s.complete = complete;
  return s;
}

// An object {parameters}. If it is left out, the member of the configuration has no value.
template <auto kMember>
Section optional(const char* key, const char* summary, Rule complete = nullptr) {
  using Settings = typename Member<kMember>::value_type;
  Section s{key, summary};
  s.entries = one_entry<Settings>;
  s.read = [](const Section& section, const Json& whole, Configuration& configuration) {
    const Json& json = given(whole, section.key);
    if (!json.is_null()) configuration.*kMember = read_settings<Settings>(json, section.key);
  };
  s.write = [](const Section& section, const Configuration& configuration, Json& whole) {
    if (configuration.*kMember) whole[section.key] = settings_json(*(configuration.*kMember));
  };
  s.complete = complete;
  return s;
}

// A list of objects {parameters}. A list that is left out is the same as an empty one.
template <auto kMember>
Section optional_list(const char* key, const char* summary, Rule complete = nullptr) {
  using Settings = typename Member<kMember>::value_type;
  Section s{key, summary};
  s.entries = one_entry<Settings>;
  s.read = [](const Section& section, const Json& whole, Configuration& configuration) {
    Settings defaults;
    configuration.*kMember = read_list<Settings>(given(whole, section.key), section.key,
                                                 parameters(defaults).front().name, read_settings<Settings>);
  };
  s.write = [](const Section& section, const Configuration& configuration, Json& whole) {
    if (!(configuration.*kMember).empty())
      whole[section.key] = list_json(configuration.*kMember, settings_json<Settings>);
  };
  s.complete = complete;
  return s;
}

// --- the table ---

using C = Configuration;

const Section kSections[] = {
    top_level<&C::run>("run", "duration, rates, delays of frames, and the seed of the noise"),
    required<&C::scenario, scenarios>("scenario", "scenarios",
                                      "the scene: point cloud frames and the true surface behind them"),
    optional<&C::faults>("faults", "simulated sensor faults, for the frames of any scenario"),
    optional<&C::depth_pipeline>("depth_pipeline",
                                 "filter of depth images and estimation of surface normals, 6.2.1"),
    list_of_entries<&C::fixtures, fixtures>(
        "fixtures", "fixture rules",
        "a list of rules that give points a forbidden region, or make them a guidance target",
        check_fixtures),
    optional<&C::guidance>("guidance",
                           "the spring that pulls the hand to fixtures with role = guidance, 7.3.2",
                           complete_guidance),
    optional_list<&C::sequence>(
        "sequence", "a list of the steps of a task, which enable and disable fixtures", check_sequence),
    required<&C::renderer, renderers>("renderer", "renderers", "what computes the force"),
    optional_list<&C::changes>("changes", "a list of settings of the renderer that change during the run",
                               check_changes),
    required<&C::trajectory, trajectories>("trajectory", "trajectories", "how the hand moves"),
    optional<&C::operator_settings>(
        "operator", "a simulated hand with mass that follows the trajectory and feels the force"),
    optional<&C::device>("device", "motors, friction, resolution and delay of the haptic device",
                         check_device),
    optional<&C::slave>("slave", "a slave robot that follows the hand in the true scene, 3.2", check_slave),
    optional<&C::command_link>("command_link", "the channel of commands from the hand to the slave"),
    optional<&C::force_link>("force_link", "the channel of forces from the slave to the hand"),
    optional<&C::frame_link>("frame_link", "which frames travel from the slave's camera to the hand"),
    optional<&C::feedback>("feedback", "what the hand feels of the scene and of the slave"),
    optional<&C::registration>("registration",
                               "error of the registration between camera and slave, of a simulated slave"),
    optional<&C::live>("live", "poses of device and camera in the world, for real-time runs"),
    optional<&C::safety>("safety",
                         "limits of force, torque and speed of a real haptic device, for real-time runs"),
};

}  // namespace

std::span<const ExperimentSection> experiment_sections() {
  return kSections;
}

void refuse_former_keys(const Json& former, const Json& json) {
  for (const Section& section : kSections) {
    const Json &before = given(former, section.key), &now = given(json, section.key);
    if (!section.heading || !before.is_object() || !has_known_name(section, now)) continue;
    const std::string name = now["name"].get<std::string>();
    if (before.value("name", Json()) == name) continue;
    for (const auto& item : before.items())
      if (now.contains(item.key()) && has(section, former, item.key()) && !has(section, json, item.key()))
        throw InputError(std::string(section.key) + "." + item.key(),
                         name + " has no such parameter: expected --set '" + section.key + "={\"name\": \"" +
                             name + "\"}', which replaces the whole object");
  }
}

ExperimentConfiguration read_configuration(const Json& json) {
  Configuration configuration;
  for (const Section& section : kSections) section.read(section, json, configuration);
  for (const Section& section : kSections)
    if (section.complete) section.complete(configuration);
  return configuration;
}

Json write_configuration(const ExperimentConfiguration& configuration) {
  Json json = Json::object();
  for (const Section& section : kSections) section.write(section, configuration, json);
  return json;
}

Json write_section_of(const ExperimentConfiguration& configuration, const std::string& key) {
  const auto is_it = [&](const Section& section) { return !section.is_top_level && section.key == key; };
  const auto found = std::find_if(std::begin(kSections), std::end(kSections), is_it);
  Json json = Json::object();
  for (const Section& section : kSections)
    if (found == std::end(kSections) ? section.is_top_level : &section == found)
      section.write(section, configuration, json);
  return json;
}

}  // namespace remote_touch

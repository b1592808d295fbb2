#include "runners/experiment/simulation/note_kinds.h"

namespace remote_touch {

namespace {

// Returns the index of a kind; 0 for a name that is not in the list.
std::size_t number_of_kind(const std::string& name) {
  const std::vector<NoteKind>& kinds = note_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (name == kinds[i].name) return i;
  return 0;
}

}  // namespace

const std::vector<NoteKind>& note_kinds() {
  static const std::vector<NoteKind> kinds = {
      {"other", "a note of your own program or plug-in; replay prints its text"},
      {"phase not reached",
       "the run ends before a press, a motion or a change begins, or before the trajectory ends"},
      {"after the motion", "the press begins after the motion of the scene has ended"},
      {"no contact", "no point was touched and no force was felt"},
      {"no frame", "no frame arrived before the run ended"},
      {"wide spacing", "a ball of the contact radius passes between the points"},
      {"points dropped", "many measured points are beyond scenario.max_depth_m"},
      {"frames unused", "not all frames of the recording were used"},
      {"frames apart", "successive frames show different parts of the scene"},
      {"unusual rate", "the stamps of the recording may not be in seconds"},
      {"recording incomplete",
       "a bag was cut short, or its stamps are missing or out of order; a live session was interrupted"},
      {"colours missing", "measured points have no colour"},
      {"viewpoint unused", "seen from its VIEWPOINT, the points of a PCD file form no image"},
      {"behind the surface", "the hand was farther behind what the camera sees than planned"},
      {"off the surface", "the hand was meant to touch but was off what the camera sees"},
      {"holes bridged", "image-scan or image-press treats holes up to bridge_m wide as closed"},
      {"edges bridged", "image-scan treats depth jumps above edge_jump_m as surface"},
      {"object not scanned", "image-scan touches another thing than the nearest object"},
      {"camera changes", "a later CameraInfo or depth unit of a bag differs from the first, which is used"},
      {"starts in contact",
       "when the first frame arrives, the hand is behind the surface or within the contact radius of it"},
      {"lost at the first touch",
       "the surface passed the proxy before a third frame after the first contact"},
      {"object not pressed", "image-press presses another thing than the nearest object"},
      {"hand jumped", "the pixel that image-press follows suddenly showed another place"},
      {"nothing selected", "a fixture rule selects no point, so that it has no effect"},
      {"outcome unknown",
       "popped_through has no value, beside an object for example; fractions of runs leave it out, and their intervals "
       "allow for both outcomes"},
      {"few frames", "fewer than three frames show the motion of the scene"},
      {"columns unused", "a measured contact has columns that are not used"},
      {"slave without surface", "the true surface, or its normal, is not known where the slave was"},
      {"slave without command",
       "the slave received no command, or none after its first, or the hand felt none of its forces"},
      {"slave loop gains energy",
       "the device gave much energy to the hand: hand, links and slave may oscillate"},
      {"setting without effect", "settings of the experiment that cannot act together"},
      {"slave starts in contact",
       "the slave starts behind the true surface, so that its largest forces may be those of its start"},
      {"force not finite", "the renderer's force is not a number in some ticks; it counts as no force there"},
      {"thin object", "the hand or the proxy passed the middle of a wall; it has no side from there on"},
      {"unusual poses",
       "a file of poses, or of a contact, is improbably fast, far or slow, or states a convention that is not read"},
      {"poses do not fit", "the frames of a recording fit each other worse with the poses of the camera"},
      {"truth elsewhere", "a true object of a recording is nowhere near what the camera measured"},
      {"not in view", "an object of a scene of meshes is at no time in the image of the camera"},
      {"camera assumed", "the intrinsics of a recording are assumed, because no file states them"},
      {"equal numbers",
       "frames of a recording have names that differ in leading zeros only; one may be a copy"},
  };
  return kinds;
}

std::vector<std::string> note_kind_names() {
  std::vector<std::string> names;
  for (const NoteKind& kind : note_kinds()) names.emplace_back(kind.name);
  return names;
}

std::uint64_t note_bits(const std::vector<Note>& notes) {
  std::uint64_t bits = 0;
  for (const Note& note : notes) bits |= std::uint64_t{1} << number_of_kind(note.kind);
  return bits;
}

std::string text_of_kind(const std::string& name) {
  const std::size_t number = number_of_kind(name);
  const NoteKind& kind = note_kinds()[number];
  return name == kind.name ? name + ": " + kind.meaning : name;
}

}  // namespace remote_touch

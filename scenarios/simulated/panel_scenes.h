// Scenes of flat panels, each sampled as a grid, which rest or move: boxes, slots and wedges for the tools of
// chapter 6.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// A flat rectangle, sampled as a grid, from which the scenes of chapter 6 are built. u, v and the normal are
// unit vectors at right angles; the normal points to the free side.
struct FlatPanel {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();
  Vec3 u = Vec3::UnitX();
  double half_u_m = 0.05, half_v_m = 0.05;

  Vec3 v() const { return normal.cross(u); }
  // Returns the point of the rectangle nearest to p.
  Vec3 nearest(const Vec3& p) const;
};

// The points' coordinates along u and v, from the centre, are whole multiples of the spacing plus the phase.
struct PanelGrid {
  double spacing_m = 0.003;
  double phase_u_m = 0, phase_v_m = 0;
};

// Adds, row after row, the points of the grid that lie on the panel, its border included, with the panel's
// normal.
void append(PointCloud& cloud, const FlatPanel& panel, const PanelGrid& grid);
// Number of points in such a row.
int columns(const FlatPanel& panel, const PanelGrid& grid);

// Returns the distance to the nearest of the panels, m, positive on the side that its normal points to. If
// several panels are equally near, the panel whose plane is farthest from p determines the side. Infinite
// without panels. A border that no other panel continues has no back side: beyond it, the distance to the
// border is positive in front of the plane that ends there, and the result is NaN behind that plane.
double signed_distance(std::span<const FlatPanel> panels, const Vec3& p);

// A scene of panels that rest or move, each sampled as a grid of points with normals.
class PanelScene : public Scenario {
 public:
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  // The panels as they are when the frame is captured.
  PointCloud cloud(int frame) const override;
  // Distance to the panels at time_s, also between frames. NaN for a position that is behind a panel and
  // beyond its border.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Returns the normal of a scene with one panel. Empty for other scenes.
  std::optional<Vec3> plane_normal(double time_s) const override;

  virtual std::vector<FlatPanel> panels(double time_s) const = 0;

 protected:
  explicit PanelScene(const PanelGrid& grid) : grid_(grid) {}

 private:
  const PanelGrid grid_;
};

// A box that is open at the top, seen from inside: the scene of 6.3.1 and Fig 6.3.
class OpenBox final : public PanelScene {
 public:
  struct Settings {
    Vec3 size_m{0.110, 0.040, 0.090};  // inside, x, y (up), z; the middle is the origin
    double spacing_m = 0.003;
    bool floor = true;
  };

  OpenBox(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m}), settings_(settings) {}
  // Walls at -x, +x, -z, +z, then the floor.
  std::vector<FlatPanel> panels(double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(OpenBox::Settings& s);
inline std::string validate(const OpenBox::Settings& s) {
  return s.size_m.minCoeff() > 0 ? "" : "size_m: expected above 0 along every axis";
}

// One panel at rest, seen from one side only, to test contact from the back too.
class SinglePanel final : public PanelScene {
 public:
  struct Settings {
    Vec3 centre_m = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();  // any length
    double width_m = 0.15;
    double height_m = 0.15;
    double spacing_m = 0.002;
  };

  SinglePanel(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m}), settings_(settings) {}
  std::vector<FlatPanel> panels(double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(SinglePanel::Settings& s);
inline std::string validate(const SinglePanel::Settings& s) {
  return s.normal.norm() > 0 ? "" : "normal = 0, 0, 0: expected any direction";
}

// Two parallel walls. A bar between them that is rotated about y stops at an angle that is known in closed
// form: a bar of 80 x 10 mm in a slot of 40 mm stops at 22.62 degrees, with its corners at x = +-35 mm.
class Slot final : public PanelScene {
 public:
  struct Settings {
    double width_m = 0.040;
    double length_m = 0.12;
    double height_m = 0.06;
    // The columns are at even millimetres: +-35 mm is half way between two, the worst position for a corner.
    double spacing_m = 0.002;
    double phase_m = 0;
  };

  Slot(const Settings& settings, const NoiseKey&, const Kernels&)
      : PanelScene({settings.spacing_m, settings.phase_m, 0}), settings_(settings) {}
  std::vector<FlatPanel> panels(double time_s) const override;  // wall at -z, then wall at +z

 private:
  const Settings settings_;
};

Parameters parameters(Slot::Settings& s);
inline std::string validate(const Slot::Settings&) {
  return {};
}

// Two walls that lean apart and close on a tool between them, until no motion obeys all constraints and (6.8)
// is infeasible.
class Wedge final : public PanelScene {
 public:
  struct Settings {
    double angle_deg = 60;
    double length_m = 0.16;
    double height_m = 0.12;
    double spacing_m = 0.002;
    double open_gap_m = 0.05;
    double closed_gap_m = 0;
    double close_start_s = 1;
    double close_end_s = 2;
    double open_start_s = 3;
    double open_end_s = 4;
    double offset_m = 0;
    double tilt_deg = 0;
    double frame_rate_hz = 30;
  };

  Wedge(const Settings& settings, const NoiseKey&, const Kernels&);
  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return frame_count_; }
  // Returns the closing and the opening of the walls. Empty if the gap is constant.
  std::vector<Phase> phases() const override;
  std::vector<FlatPanel> panels(double time_s) const override;  // wall at -z, then wall at +z
  // Distance between the lower edges of the walls, m; linear in time while it changes.
  double gap_m(double time_s) const;

 private:
  const Settings settings_;
  int frame_count_;
  Vec3 up_, across_;      // axes of the wedge: y and z, tilted about x
  double sine_, cosine_;  // sine and cosine of half the angle
};

Parameters parameters(Wedge::Settings& s);
std::string validate(const Wedge::Settings& s);

// Flat plates that hide each other from a camera above them: a nearer object passes or enters, or two objects
// move apart. The camera looks along -y with parallel rays through the nodes of the grid, which do not move.
// Each ray sees the highest plate at its node. It sees nothing if there is no plate, or if that plate is
// above max_height_m: it is then too near to be measured, but hides what is below. The points are stored row
// by row; noise is added in the world frame. The true surface is the first plate, whether it is hidden or
// not.
class Plates final : public GridScene {
 public:
  struct Settings {
    Grid grid{80, 80, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    // One row for each plate: x, y and z of the centre, size along x and along z, velocity along x and along
    // y, and the times at which the plate starts and stops moving.
    std::vector<double> plates{0, 0, 0, 0.2, 0.2, 0, 0, 0, 0};
    double max_height_m = 10;
    double noise_sigma_m = 0;
    SurfaceTime truth = SurfaceTime::newest_frame;
  };
  static constexpr std::size_t kColumns = 9;

  Plates(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels, settings.truth == SurfaceTime::moving), settings_(settings) {}

  int frame_count() const override;
  // Returns the motion of each plate that moves, in the order of their end times.
  std::vector<Phase> phases() const override;
  PointCloud cloud(int frame) const override;
  // Distance to the first plate, positive above it. Beyond its border it is the distance to the border if p
  // is above the plane, and NaN if p is below it.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Height of the first plate, continued beyond its border.
  double surface_height(double x, double z, double time_s) const override;

  // Position and size of a plate at a time.
  FlatPanel plate(std::size_t number, double time_s) const;

 private:
  bool moves(std::size_t number) const;
  std::size_t plate_count() const { return settings_.plates.size() / kColumns; }

  const Settings settings_;
};

Parameters parameters(Plates::Settings& s);
std::string validate(const Plates::Settings& s);

}  // namespace remote_touch

// SPDX-License-Identifier: Apache-2.0
// Sensors of machines as data, one struct per kind of sensor. The classes in sensor/kinds/ take
// their readings. Names and meanings of the elements are those of SDF where SDF has the sensor;
// elements in `navvy:` are additions. S is the sensor's frame: x forward, y left, z up.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/math.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Maximum number of sensors of a link, and number of those that a scene adds to a machine.
inline constexpr std::size_t kMostSensors = 100;
/// Maximum number of beams of a sensor, of pixels of a camera, and of cells of a sensor's map.
inline constexpr double kMostBeams = 4e6;

/// Random errors of one measured value, as in SDF's <noise>: reading = round(value + bias +
/// Gaussian error), with a bias that is drawn once and drifts if it has a correlation time. Values
/// are in the unit of the measured value.
struct SensorNoise {
  std::string type = "none";  ///< "none", "gaussian" or "gaussian_quantized"
  double mean = 0;            ///< mean of the Gaussian error
  double stddev = 0;          ///< standard deviation of the Gaussian error
  double bias_mean = 0;       ///< mean of the bias
  double bias_stddev = 0;     ///< standard deviation of the bias; its sign is random
  double precision = 0;       ///< step of the output; 0: not rounded
  double drift_stddev = 0;    ///< standard deviation of the drifting part of the bias
  double drift_time = 0;      ///< correlation time of the drift [s]; 0: no drift

  /// Returns true if the readings differ from the true values.
  bool active() const { return type != "none"; }
  /// Passes the fields of a <noise> to the visitor `f`.
  void describe(Fields& f) {
    // The sensors of SDF differ in how they state the type; both forms are read.
    f.attribute("type", type, "Type of the noise: none, gaussian or gaussian_quantized.");
    f("type", type, "Type of the noise where SDF has an element: none or gaussian.", kSdf);
    f("mean", mean, {-1e9, 1e9}, "Mean of the Gaussian error.", kSdf);
    f("stddev", stddev, {0, 1e9}, "Standard deviation of the Gaussian error.", kSdf);
    f("bias_mean", bias_mean, {-1e9, 1e9}, "Mean of the bias, which is drawn once.", kSdf);
    f("bias_stddev", bias_stddev, {0, 1e9}, "Standard deviation of the bias.", kSdf);
    f("precision", precision, {0, 1e9}, "Step of the readings; 0: not rounded.", kSdf);
    f("dynamic_bias_stddev", drift_stddev, {0, 1e9},
      "Standard deviation of the drifting part of the bias.", kSdf);
    f("dynamic_bias_correlation_time", drift_time, {0, 1e6},
      "Correlation time of the drift, in seconds; 0: no drift.", kSdf);
  }
};

/// A <noise> inside an element that holds nothing else, such as the x axis of an IMU.
struct NoiseOfValue {
  SensorNoise noise;  ///< random errors of the value

  /// Passes the fields of the element around a <noise> to the visitor `f`.
  void describe(Fields& f) { f("noise", noise, "Random errors.", kSdf); }
};

/// Random errors of three components.
struct NoiseOfVector {
  NoiseOfValue x, y, z;  ///< errors along the axes of the sensor

  /// Passes the three components to the visitor `f`.
  void describe(Fields& f) {
    f("x", x, "Errors along x of the sensor.", kSdf);
    f("y", y, "Errors along y of the sensor.", kSdf);
    f("z", z, "Errors along z of the sensor.", kSdf);
  }
};

/// Directions of beams, equally spaced from `min_angle` to `max_angle`, both included.
struct BeamFan {
  int samples = 1;        ///< number of beams
  double resolution = 1;  ///< readings / beams; only 1 is supported
  double min_angle = 0;   ///< angle of the first beam [rad]
  double max_angle = 0;   ///< angle of the last beam [rad]

  /// Returns the angle of beam number i [rad].
  double angle(int i) const {
    return samples < 2 ? 0.5 * (min_angle + max_angle)
                       : min_angle + (max_angle - min_angle) * i / (samples - 1);
  }
  /// Passes the fields of a <horizontal> or <vertical> to the visitor `f`.
  void describe(Fields& f) {
    f("samples", samples, {1, 100000}, "Number of beams.", kSdf | kNeeded);
    f("resolution", resolution, {1, 1}, "Readings per beam, which is 1.", kSdf);
    f("min_angle", min_angle, {-6.3, 6.3}, "Angle of the first beam, in radians.", kSdf);
    f("max_angle", max_angle, {-6.3, 6.3}, "Angle of the last beam, in radians.", kSdf);
  }
};

/// Smallest and largest distance that a sensor measures.
struct SensedRange {
  double min = 0.05;      ///< distance below which nothing is measured [m]
  double max = 20;        ///< distance beyond which nothing is measured [m]
  double resolution = 0;  ///< step of the readings [m]; 0: not rounded

  /// Passes the fields of a <range> to the visitor `f`.
  void describe(Fields& f) {
    f("min", min, {0, 1e5}, "Smallest distance, in metres.", kSdf);
    f("max", max, {1e-3, 1e5}, "Largest distance, in metres.", kSdf);
    f("resolution", resolution, {0, 1e3}, "Step of the readings, in metres; 0: not rounded.", kSdf);
  }
};

/// Errors that beams have beside their noise.
struct BeamErrors {
  double outliers = 0;  ///< share of the readings that are drawn uniformly over the range [-]
  double dropped = 0;   ///< share of the beams that return nothing [-]

  /// Passes the fields of the errors to the visitor `f`.
  void describe(Fields& f) {
    f("navvy:outlier_share", outliers, {0, 1},
      "Share of the readings that are replaced by any distance in the range.");
    f("navvy:drop_share", dropped, {0, 1}, "Share of the beams that return nothing.");
  }
};

/// Laser scanner: a fan of thin beams in one or several rings.
struct Lidar {
  BeamFan horizontal{361, 1, -kPi / 2, kPi / 2};  ///< beams of a ring, about z of S
  BeamFan vertical;                               ///< rings, upwards positive
  SensedRange range;                              ///< measured distances
  SensorNoise noise;                              ///< errors of a distance [m]
  /// Time from the first to the last column of a scan [s]; 0: all beams at one instant.
  double sweep = 0;
  BeamErrors errors;  ///< outliers and dropped beams

  /// Passes the fields of a laser scanner to the visitor `f`.
  void describe(Fields& f) {
    const auto body = [this](Fields& g) {
      g.group({"scan", "Directions of the beams.", kSdf}, [this](Fields& h) {
        h("horizontal", horizontal, "Beams of a ring, from right to left.", kSdf);
        h("vertical", vertical, "Rings, from the lowest to the highest.", kSdf);
      });
      g("range", range, "Measured distances.", kSdf);
      g("noise", noise, "Random errors of a distance, in metres.", kSdf);
    };
    f.group({"lidar", "Beams of a laser scanner.", kSdf}, body);
    f.group({"ray", "Former name of <lidar>.", kSdf}, body);
    f("navvy:sweep_s", sweep, {0, 10},
      "Time from the first to the last beam of a ring: each sees what is there at its own "
      "instant.");
    errors.describe(f);
  }
};

/// Ultrasonic sensor: the distance to the closest thing in a cone about x of S.
struct Sonar {
  std::string geometry = "cone";  ///< shape of the beam; only "cone" is supported
  double min = 0.15;              ///< smallest distance [m]
  double max = 5;                 ///< largest distance [m]
  double radius = 1.34;           ///< radius of the cone at the largest distance [m]
  int beams = 64;                 ///< number of rays by which the cone is sampled
  SensorNoise noise;              ///< errors of the distance [m]
  BeamErrors errors;              ///< outliers and lost echoes

  /// Passes the fields of an ultrasonic sensor to the visitor `f`.
  void describe(Fields& f) {
    f.group({"sonar", "Cone of an ultrasonic sensor.", kSdf}, [this](Fields& g) {
      g("geometry", geometry, "Shape of the beam: cone.", kSdf);
      g("min", min, {0, 1e3}, "Smallest distance, in metres.", kSdf);
      g("max", max, {1e-3, 1e3}, "Largest distance, in metres.", kSdf);
      g("radius", radius, {0, 1e3}, "Radius of the cone at the largest distance, in metres.", kSdf);
    });
    f("navvy:beams", beams, {1, 10000}, "Number of rays by which the cone is sampled.");
    f("navvy:noise", noise, "Random errors of the distance, in metres.");
    errors.describe(f);
  }
};

/// Infrared distance sensor: one narrow beam along x of S that averages over its spot.
struct Infrared {
  SensedRange range{0.04, 1.5, 0};  ///< measured distances
  double spot = 0;                  ///< full angle of the beam [rad]
  SensorNoise noise;                ///< errors of the distance [m]
  BeamErrors errors;                ///< outliers and lost readings

  /// Passes the fields of an infrared sensor to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:infrared", "Beam of an infrared sensor.", {}}, [this](Fields& g) {
      g("range", range, "Measured distances.");
      g("spot_deg", spot, {0, 30}, "Full angle of the beam, over which it averages.");
      g("noise", noise, "Random errors of the distance, in metres.");
    });
    errors.describe(f);
  }
};

/// Time-of-flight (PMD) camera: distances by the phase of modulated light, which is ambiguous
/// beyond c / (2 f). A pixel at an edge mixes near and far light to a distance in between (a
/// flying pixel).
struct TimeOfFlight {
  int width = 64, height = 48;     ///< number of pixels
  double fov = radians(40);        ///< horizontal field of view [rad]
  double modulation = 20e6;        ///< modulation frequency [Hz]
  SensedRange range{0.1, 7.5, 0};  ///< distances at which enough light returns
  int rays = 2;                    ///< a pixel is sampled by rays x rays beams
  SensorNoise noise;               ///< errors of a distance [m]
  BeamErrors errors;               ///< outliers and dark pixels

  /// Passes the fields of a time-of-flight camera to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:time_of_flight", "Optics of a time-of-flight camera.", {}}, [this](Fields& g) {
      g("width", width, {1, 4096}, "Number of pixels along a row.");
      g("height", height, {1, 4096}, "Number of rows.");
      g("horizontal_fov_deg", fov, {1, 170}, "Horizontal field of view.");
      g("modulation_hz", modulation, {1e5, 1e9}, "Modulation frequency.");
      g("range", range, "Distances at which enough light returns.");
      g("rays", rays, {1, 8}, "A pixel is sampled by rays x rays beams.");
      g("noise", noise, "Random errors of a distance, in metres.");
    });
    errors.describe(f);
  }
};

/// Inertial measurement unit: angular velocity and specific force in S, and the true orientation.
struct Imu {
  NoiseOfVector angular_velocity;     ///< errors of the angular velocity [rad/s]
  NoiseOfVector linear_acceleration;  ///< errors of the specific force [m/s2]

  /// Passes the fields of an inertial measurement unit to the visitor `f`.
  void describe(Fields& f) {
    f.group({"imu", "Errors of an inertial measurement unit.", kSdf}, [this](Fields& g) {
      g("angular_velocity", angular_velocity, "Errors of the angular velocity, in rad/s.", kSdf);
      g("linear_acceleration", linear_acceleration, "Errors of the specific force, in m/s2.", kSdf);
    });
  }
};

/// Satellite receiver: position and velocity in W. It loses its fix while fewer than four
/// satellites are visible past ground, machines and bodies.
struct Gnss {
  /// Errors of the horizontal and of the vertical components.
  struct Sensing {
    NoiseOfValue horizontal, vertical;  ///< errors of x and y, and of z

    /// Passes the fields of a <position_sensing> to the visitor `f`.
    void describe(Fields& f) {
      f("horizontal", horizontal, "Errors of x and of y.", kSdf);
      f("vertical", vertical, "Errors of z.", kSdf);
    }
  };
  Sensing position;           ///< errors of the position [m]
  Sensing velocity;           ///< errors of the velocity [m/s]
  int satellites = 12;        ///< number of satellites, spread over the sky
  double mask = radians(10);  ///< smallest elevation of a satellite [rad]
  double reacquire = 1;       ///< time from the first clear view to the next fix [s]

  /// Passes the fields of a satellite receiver to the visitor `f`.
  void describe(Fields& f) {
    const auto body = [this](Fields& g) {
      g("position_sensing", position, "Errors of the position, in metres.", kSdf);
      g("velocity_sensing", velocity, "Errors of the velocity, in m/s.", kSdf);
    };
    f.group({"navsat", "Errors of a satellite receiver.", kSdf}, body);
    f.group({"gps", "Former name of <navsat>.", kSdf}, body);
    f("navvy:satellites", satellites, {4, 100}, "Number of satellites, spread over the sky.");
    f("navvy:mask_deg", mask, {0, 80}, "Smallest elevation of a satellite that is used.");
    f("navvy:reacquire_s", reacquire, {0, 3600},
      "Time without obstruction after which a lost fix returns.");
  }
};

/// Sensor of a joint: position, velocity, and torque or force.
struct JointGauge {
  std::string joint;                        ///< name of the joint
  NoiseOfValue position, velocity, effort;  ///< errors of the three values

  /// Passes the fields of a joint's sensor to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:joint", "Joint that is measured.", kNeeded}, [this](Fields& g) {
      g("joint", joint, Refers::kJoint, "Name of the joint.", kNeeded);
      g("position", position, "Errors of the position, in rad or m.");
      g("velocity", velocity, "Errors of the velocity, in rad/s or m/s.");
      g("effort", effort, "Errors of the torque or force, in N m or N.");
    });
  }
};

/// Pressures in the two chambers of a hydraulic cylinder, and its length.
struct CylinderPressure {
  std::string cylinder;          ///< name of the cylinder
  SensorNoise pressure, length;  ///< errors of a pressure [Pa] and of the length [m]

  /// Passes the fields of a pressure sensor to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:cylinder", "Cylinder that is measured.", kNeeded}, [this](Fields& g) {
      g("cylinder", cylinder, "Name of the cylinder.", kNeeded);
      g("noise", pressure, "Errors of a pressure, in Pa.");
      g("length_noise", length, "Errors of the length, in m.");
    });
  }
};

/// Contact switch: the contacts of a link with other machines and bodies.
struct ContactSwitch {
  std::string collision;  ///< name of a collision of the link; the whole link is sensed
  double threshold = 0;   ///< normal force above which the switch closes [N]

  /// Passes the fields of a contact switch to the visitor `f`.
  void describe(Fields& f) {
    f.group({"contact", "Shape that is sensed.", kSdf}, [this](Fields& g) {
      g("collision", collision, "Collision of the link; all shapes of the link are sensed.", kSdf);
    });
    f("navvy:threshold_n", threshold, {0, 1e9}, "Force above which the switch closes.");
  }
};

/// Force and moment of the soil on a bucket or blade, in S about the origin of S.
struct ToolForce {
  std::string shell;          ///< name of the tool's shell
  SensorNoise force, moment;  ///< errors of a component of force [N] and of moment [N m]

  /// Passes the fields of a force sensor to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:tool_force", "Tool that is measured.", kNeeded}, [this](Fields& g) {
      g("shell", shell, Refers::kShell, "Shell of the tool.", kNeeded);
      g("noise", force, "Errors of a component of the force, in N.");
      g("moment_noise", moment, "Errors of a component of the moment, in N m.");
    });
  }
};

/// Scale for the soil in a bucket or bed.
struct PayloadScale {
  std::string shell;       ///< name of the shell of the bucket or bed
  double scale_error = 0;  ///< standard deviation of the factor on the mass, drawn once [-]
  SensorNoise noise;       ///< errors of the mass [kg]

  /// Passes the fields of a scale to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:payload", "Bucket or bed that is weighed.", kNeeded}, [this](Fields& g) {
      g("shell", shell, Refers::kShell, "Shell of the bucket or bed.", kNeeded);
      g("scale_error", scale_error, {0, 1},
        "Standard deviation of the relative error, which is drawn once.");
      g("noise", noise, "Random errors of the mass, in kg.");
    });
  }
};

/// Camera for depth or labels, by rays through the middles of its pixels.
struct DepthCamera {
  double fov = 1.047;           ///< horizontal field of view [rad]
  int width = 0, height = 0;    ///< number of pixels
  double near = 0.1, far = 20;  ///< smallest and largest depth along x of S [m]
  SensorNoise noise;            ///< errors of a depth [m]
  std::string format;           ///< element without effect

  /// Passes the fields of a camera to the visitor `f`.
  void describe(Fields& f) {
    f.group({"camera", "Optics of a camera.", kSdf | kNeeded}, [this](Fields& g) {
      g("horizontal_fov", fov, {0.01, 3.1}, "Horizontal field of view, in radians.", kSdf);
      g.group({"image", "Size of the picture.", kSdf | kNeeded}, [this](Fields& h) {
        h("width", width, {1, 8192}, "Number of pixels along a row.", kSdf | kNeeded);
        h("height", height, {1, 8192}, "Number of rows.", kSdf | kNeeded);
        h("format", format, "Read and ignored: depths are float32, labels uint16.", kSdf);
      });
      g.group({"clip", "Depths that are measured.", kSdf}, [this](Fields& h) {
        h("near", near, {1e-3, 1e4}, "Smallest depth, in metres.", kSdf);
        h("far", far, {1e-2, 1e5}, "Largest depth, in metres.", kSdf);
      });
      g("noise", noise, "Random errors of a depth, in metres.", kSdf);
    });
  }
};

/// Camera that labels pixels: 0 nothing, 1 ground, 2 loose soil, 3 + i the machine with index i.
struct LabelCamera : DepthCamera {};

/// Camera for colour pictures in 8-bit sRGB, drawn as the pictures of a scene's cameras are.
struct ColourCamera {
  double fov = 1.047;         ///< horizontal field of view [rad]
  int width = 0, height = 0;  ///< number of pixels
  SensorNoise noise;          ///< errors of a colour, on a scale from 0 to 1
  /// Elements without effect.
  std::string format, near, far;

  /// Passes the fields of a camera to the visitor `f`.
  void describe(Fields& f) {
    f.group({"camera", "Optics of a camera.", kSdf | kNeeded}, [this](Fields& g) {
      g("horizontal_fov", fov, {0.02, 2.96}, "Horizontal field of view, in radians.", kSdf);
      g.group({"image", "Size of the picture.", kSdf | kNeeded}, [this](Fields& h) {
        h("width", width, {1, 8192}, "Number of pixels along a row.", kSdf | kNeeded);
        h("height", height, {1, 8192}, "Number of rows.", kSdf | kNeeded);
        h("format", format, "Read and ignored: pictures are 8-bit RGB.", kSdf);
      });
      g.group({"clip", "Read and ignored.", kSdf}, [this](Fields& h) {
        h("near", near, "Read and ignored: pictures show all from 0.12 m on.", kSdf);
        h("far", far, "Read and ignored: pictures show all.", kSdf);
      });
      g("noise", noise, "Random errors of a colour, on a scale from 0 to 1.", kSdf);
    });
  }
};

/// Two equal colour cameras side by side. The left one is at the origin of S.
struct StereoCamera : ColourCamera {
  double baseline = 0.12;  ///< distance from the left camera to the right one, along -y of S [m]

  /// Passes the fields of a pair of cameras to the visitor `f`.
  void describe(Fields& f) {
    ColourCamera::describe(f);
    f("navvy:baseline_m", baseline, {1e-3, 10},
      "Distance from the left camera, at the origin of the sensor, to the right one.");
  }
};

/// Map of the ground that a machine makes from the scans of its own laser scanners. It shows what
/// they have seen, with their errors and gaps, and beside it a prediction of what the machine's
/// buckets have done to ground that nothing has seen since.
struct OwnMap {
  double cell = 0;                                ///< edge of a cell [m]; 0: a column's
  bool has_area = false;                          ///< true: `min` and `max` were given
  Vec2 min = Vec2(-10, -10), max = Vec2(10, 10);  ///< corners of the map in W [m]
  bool self_filter = true;                        ///< true: points on the machine are left out
  double margin = 0.1;                            ///< distance within which they are on it [m]
  double memory = 3;                              ///< weight of old points, in new points [-]

  /// Passes the fields of a map to the visitor `f`.
  void describe(Fields& f) {
    f.group({"navvy:map", "Grid of the map.", {}}, [this](Fields& g) {
      g("cell_m", cell, {0.01, 100}, "Edge of a cell; by default that of the ground's columns.");
      g("min_m", min, {-1e6, 1e6}, "Corner in W of least x and y; by default that of the site.",
        given(has_area));
      g("max_m", max, {-1e6, 1e6}, "Corner in W of greatest x and y; needed with min_m.");
      g("self_filter", self_filter,
        "Leave out points on the machine itself and on the soil in its buckets and beds.");
      g("margin_m", margin, {0, 10}, "Distance within which a point is on the machine.");
      g("memory", memory, {0, 1000}, "Weight of all earlier points of a cell, in new points.");
    });
  }
};

/// The part of a sensor that depends on its kind.
using SensorKind = std::variant<Lidar, Sonar, Infrared, TimeOfFlight, Imu, Gnss, JointGauge,
                                CylinderPressure, ContactSwitch, ToolForce, PayloadScale,
                                DepthCamera, LabelCamera, ColourCamera, StereoCamera, OwnMap>;

/// A value of the attribute `type` of a <sensor>, and the index in SensorKind that it stands for.
struct SensorType {
  const char* name;  ///< value of the attribute
  std::size_t kind;  ///< index in SensorKind
};
/// Returns all values of the attribute `type` that are read.
const std::vector<SensorType>& sensor_types();

/// Elements of SDF's <sensor> that a file may have and that change nothing here.
struct IgnoredOfSensor {
  /// Value of each element, which only its presence matters of.
  std::string visualize, always_on, topic, enable_metrics;

  /// Passes the ignored elements to the visitor `f`.
  void describe(Fields& f) {
    f("visualize", visualize, "Read and ignored: beams are not drawn.", kSdf);
    f("always_on", always_on, "Read and ignored: sensors are always on.", kSdf);
    f("topic", topic, "Read and ignored: names follow from machine and sensor.", kSdf);
    f("enable_metrics", enable_metrics, "Read and ignored.", kSdf);
  }
};

/// A sensor on a link of a machine. It reads the world and changes nothing in it.
struct Sensor {
  std::string name;            ///< name of the sensor, unique within its machine
  std::string link;            ///< link that carries a <navvy:sensor>; empty: it is inside a <link>
  std::string type = "lidar";  ///< value of the attribute `type`, one of `sensor_types`
  std::string preset;          ///< name of the preset that fills in missing elements; may be empty
  Pose X_LS = Pose::Identity();  ///< pose of the sensor in the link's frame
  double rate = 0;               ///< readings per second [1/s]
  double latency = 0;            ///< time from the measurement to its delivery [s]
  SensorKind kind;               ///< what it measures, and how
  IgnoredOfSensor ignored;       ///< elements without effect
  std::string file;              ///< file that describes the sensor, for messages
  int line = 0;                  ///< line in that file; 0: from the command line

  /// Passes the fields of a <sensor> to the visitor `f`.
  void describe(Fields& f);
};

}  // namespace navvy::scene

#include "scenarios/files/depth_images.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <utility>

#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// An image axis: pixel = focal * ratio + centre, where ratio is x/z or y/z.
struct AxisFit {
  double focal = 0, centre = 0;
  double residual = 0;  // residual of the worst point, pixels
};

// Fits pixel as a linear function of ratio, by least squares over the valid points. In this direction the fit
// minimises residuals in pixels. The sums are taken about the means, so that they keep their digits.
std::optional<AxisFit> fit_axis(const std::vector<double>& ratios, std::size_t columns, bool across) {
  const auto for_valid = [&](auto visit) {
    for (std::size_t first = 0, v = 0; first < ratios.size(); first += columns, ++v) {
      for (std::size_t u = 0; u < columns; ++u) {
        const double ratio = ratios[first + u];
        if (!std::isnan(ratio)) visit(ratio, static_cast<double>(across ? u : v));
      }
    }
  };
  double n = 0, mean_ratio = 0, mean_pixel = 0;
  for_valid([&](double ratio, double pixel) { ++n, mean_ratio += ratio, mean_pixel += pixel; });
  if (n == 0) return std::nullopt;
  mean_ratio /= n, mean_pixel /= n;
  double ratio_2 = 0, ratio_pixel = 0, pixel_2 = 0;
  for_valid([&](double ratio, double pixel) {
    const double r = ratio - mean_ratio, p = pixel - mean_pixel;
    ratio_2 += r * r, ratio_pixel += r * p, pixel_2 += p * p;
  });
  if (ratio_2 <= 0 || pixel_2 < 0.25) return std::nullopt;  // less than two columns (or rows) of pixels
  AxisFit fit{ratio_pixel / ratio_2, 0, 0};
  fit.centre = mean_pixel - fit.focal * mean_ratio;
  for_valid([&](double ratio, double pixel) {
    fit.residual = std::max(fit.residual, std::abs(fit.focal * ratio + fit.centre - pixel));
  });
  return fit;
}

// Computes across / z of each point; NaN for a missing point. Pre: points are in front of the camera.
std::vector<double> ratios(const std::vector<double>& across, const std::vector<double>& z) {
  std::vector<double> result(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) result[i] = across[i] / z[i];
  return result;
}

// Makes the name of a chunk printable: a damaged file may have any bytes there.
std::string printable(std::string name) {
  for (char& c : name)
    if (!std::isalpha(static_cast<unsigned char>(c))) c = '?';
  return name;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// One PNG file being decoded. libpng reports an error by a jump to setjmp, which skips destructors: each step
// that calls libpng keeps its state in members, and guarded() turns the error into an exception after the
// jump.
class PngFile {
 public:
  explicit PngFile(const std::filesystem::path& path) : name_(path.string()) {
    std::error_code no_size;
    file_bytes_ = std::filesystem::file_size(path, no_size);  // fails also for a folder
    if (no_size) refuse(name_, "cannot be read (", no_size.message(), "): expected a PNG file");
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) refuse(name_, "cannot be opened: ", std::strerror(errno));
    start();
  }

  // bytes must outlive it.
  PngFile(std::string_view bytes, const std::string& name) : name_(name), file_bytes_(bytes.size()) {
    if (bytes.empty()) refuse(name_, "holds no byte of an image: expected a PNG");
    // Opened for reading only: the bytes stay as they are.
    file_.reset(fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"));
    if (!file_) throw std::bad_alloc();
    start();
  }

  ~PngFile() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  int width() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  int height() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  int bit_depth() const { return png_get_bit_depth(png_, info_); }
  int colour_type() const { return png_get_color_type(png_, info_); }
  std::string pixel_format() const {
    const int type = colour_type();
    std::string name = std::to_string(bit_depth()) + "-bit ";
    name += type == PNG_COLOR_TYPE_PALETTE ? "palette" : (type & PNG_COLOR_MASK_COLOR) ? "RGB" : "grey";
    if (type & PNG_COLOR_MASK_ALPHA) name += " with alpha";
    return name;
  }

  // Returns the rows one after the other: as stored, or as 8-bit red, green, blue, alpha (255 if the file has
  // none).
  const std::vector<png_byte>& decode_as_stored() { return decode(&PngFile::prepare_as_stored); }
  const std::vector<png_byte>& decode_as_rgba() { return decode(&PngFile::prepare_as_rgba); }

 private:
  using Step = void (PngFile::*)();

  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngFile*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
  }

  static void on_warning(png_structp, png_const_charp) {}  // the pixels are usable

  void start() {
    check_chunks();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (!png_) throw std::bad_alloc();
    info_ = png_create_info_struct(png_);
    try {
      if (!info_) throw std::bad_alloc();
      guarded(&PngFile::read_header);
    } catch (...) {  // the destructor does not run for a constructor that throws
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
  }

  void guarded(Step step) {
    if (setjmp(png_jmpbuf(png_))) refuse(name_, "is not a whole PNG file: ", message_);
    (this->*step)();
  }

  const std::vector<png_byte>& decode(Step prepare) {
    check_claimed_size();
    guarded(prepare);
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);
    bytes_.resize(row_bytes * height());
    for (int v = 0; v < height(); ++v) rows_.push_back(bytes_.data() + row_bytes * v);
    guarded(&PngFile::read_pixels);
    return bytes_;
  }

  // Throws InputError if a chunk claims more bytes than the file has: libpng would allocate them before it
  // reads.
  void check_chunks() {
    constexpr std::uintmax_t kSignature = 8, kAroundData = 12;  // length, type and CRC
    std::array<unsigned char, 8> start{};                       // length and type
    for (std::uintmax_t at = kSignature; at + kAroundData <= file_bytes_;) {
      if (std::fseek(file_.get(), static_cast<long>(at), SEEK_SET) != 0 ||
          std::fread(start.data(), 1, start.size(), file_.get()) != start.size())
        break;  // libpng reports the cause
      const std::uintmax_t length = png_get_uint_32(start.data());
      const std::string type(reinterpret_cast<const char*>(start.data()) + 4, 4);
      if (length > file_bytes_ - at - kAroundData)
        refuse(name_, "is not a whole PNG file: ", printable(type), " claims ", length, " bytes");
      if (type == "IEND") break;
      at += kAroundData + length;
    }
    std::rewind(file_.get());
  }

  // A header may claim an image that would not fit in memory. Deflate expands at most 1032 times.
  void check_claimed_size() const {
    constexpr std::uintmax_t kMaxExpansion = 1032, kMaxPixels = 1u << 26;  // 8192 x 8192: 0.7 GB as depths
    if (static_cast<std::uintmax_t>(width()) * static_cast<std::uintmax_t>(height()) > kMaxPixels)
      refuse(name_, "claims ", width(), " x ", height(), " pixels: expected up to ", kMaxPixels, " in all");
    const std::uintmax_t claimed = static_cast<std::uintmax_t>(height()) * png_get_rowbytes(png_, info_);
    if (claimed / kMaxExpansion > file_bytes_)
      refuse(name_, "claims ", width(), " x ", height(), " pixels: more than its ", file_bytes_,
             " bytes can hold");
  }

  void read_header() {
    // No memory for texts and profiles.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_init_io(png_, file_.get());
    png_read_info(png_, info_);
  }

  void prepare_as_stored() {
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
  }

  void prepare_as_rgba() {
    png_set_expand(png_);  // palette and 1, 2, 4 bits to 8, transparent colours to alpha
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
    prepare_as_stored();
  }

  void read_pixels() {
    // Reads interlaced images too, because libpng makes all passes over the rows.
    png_read_image(png_, rows_.data());
    png_read_end(png_, nullptr);  // detects a file that was cut short behind the pixels
  }

  std::string name_;
  std::uintmax_t file_bytes_ = 0;
  std::unique_ptr<std::FILE, CloseFile> file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[128] = "";
  std::vector<png_byte> bytes_;
  std::vector<png_bytep> rows_;
};

GreyImage grey_image(PngFile& png, const std::string& name) {
  if (png.colour_type() != PNG_COLOR_TYPE_GRAY || png.bit_depth() != 16)
    refuse(name, "pixels are ", png.pixel_format(), ": expected 16-bit grey (one channel)");
  const std::vector<png_byte>& bytes = png.decode_as_stored();
  GreyImage image{png.width(), png.height(), std::vector<std::uint16_t>(bytes.size() / 2)};
  for (std::size_t i = 0; i < image.values.size(); ++i)  // PNG is big-endian
    image.values[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  return image;
}

constexpr std::size_t kMaxNpySide = 65535, kMaxNpyPixels = 1u << 26;  // as of PNG files

struct NpyHeader {
  std::string type;  // as NumPy writes it: "<f4"
  bool is_fortran = false;
  std::size_t height = 0, width = 0;
  std::size_t data_at = 0;
};

std::string bytes_in(const std::filesystem::path& file) {
  std::error_code unreachable;
  const std::uintmax_t size = std::filesystem::file_size(file, unreachable);
  if (unreachable) refuse(file, "cannot be read: ", unreachable.message());
  constexpr std::uintmax_t kMaxBytes = kMaxNpyPixels * sizeof(double) + 65536;
  if (size > kMaxBytes)
    refuse(file, "has ", size, " bytes: expected an image of at most ", kMaxNpyPixels, " pixels");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) refuse(file, "cannot be read");
  return bytes;
}

// Returns the values of a dictionary of Python, such as {'descr': '<f4', 'fortran_order': False, 'shape': (2,
// 3), }, by their keys and without blanks and quotes.
std::map<std::string, std::string> dictionary(std::string_view text) {
  std::map<std::string, std::string> values;
  std::string key, word;
  bool is_in_brackets = false;
  for (const char c : text) {
    if (c == '(') is_in_brackets = true;
    if (c == ')') is_in_brackets = false;
    if (c == ':' && key.empty()) {
      key = std::exchange(word, {});
    } else if ((c == ',' && !is_in_brackets) || c == '}') {
      if (!key.empty()) values[std::exchange(key, {})] = word;
      word.clear();
    } else if (std::string_view(" \n\t{'\"").find(c) == std::string_view::npos) {
      word += c;
    }
  }
  return values;
}

// Returns false unless the text is "(HEIGHT,WIDTH)" with sides from 1 to kMaxNpySide.
bool read_shape(const std::string& text, NpyHeader& header) {
  const char *at = text.data(), *const end = at + text.size();
  const auto read = [&](char before, std::size_t& side) {
    if (at == end || *at++ != before) return false;
    const auto [next, error] = std::from_chars(at, end, side);
    at = next;
    return error == std::errc() && side >= 1 && side <= kMaxNpySide;
  };
  return read('(', header.height) && read(',', header.width) && std::string_view(at, end) == ")";
}

NpyHeader header_of(const std::filesystem::path& file, const std::string& bytes) {
  constexpr std::string_view kMagic{"\x93NUMPY", 6};
  constexpr std::size_t kVersion = kMagic.size(), kLength = kVersion + 2;
  if (!bytes.starts_with(kMagic) || bytes.size() < kLength + 4)
    refuse(file, "does not begin as a NumPy file");
  const auto byte = [&](std::size_t at) { return std::size_t{static_cast<unsigned char>(bytes[at])}; };
  const std::size_t length_bytes = byte(kVersion) == 1 ? 2 : 4;
  NpyHeader header;
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;) length = length << 8 | byte(kLength + i);
  if (length > bytes.size() - kLength - length_bytes) refuse(file, "ends within its header");
  header.data_at = kLength + length_bytes + length;
  auto values = dictionary(std::string_view(bytes).substr(kLength + length_bytes, length));
  header.type = values["descr"];
  header.is_fortran = values["fortran_order"] == "True";
  if (!read_shape(values["shape"], header))
    refuse(file, "has the shape \"", values["shape"].substr(0, 32),
           "\": expected (height, width) of an image");
  if (header.height * header.width > kMaxNpyPixels)
    refuse(file, "has ", header.height * header.width, " pixels: expected at most ", kMaxNpyPixels);
  return header;
}

// Returns the values in the order of the file.
template <class Value>
std::vector<double> values_of(const std::filesystem::path& file, const std::string& bytes,
                              const NpyHeader& header) {
  const std::size_t count = header.height * header.width;
  if (bytes.size() - header.data_at != count * sizeof(Value))
    refuse(file, "has ", bytes.size() - header.data_at, " bytes of data: expected ", count * sizeof(Value),
           ", as its header says");
  std::vector<double> values(count);
  const char* at = bytes.data() + header.data_at;
  for (double& value : values)
    value = static_cast<double>(number_at<Value>(at, header.type[0] == '>')), at += sizeof(Value);
  return values;
}

std::vector<double> numbers_in(const std::filesystem::path& file, const std::string& bytes,
                               const NpyHeader& header) {
  const std::string kind = header.type.empty() ? "" : header.type.substr(1);
  if (kind == "f4") return values_of<float>(file, bytes, header);
  if (kind == "f8") return values_of<double>(file, bytes, header);
  if (kind == "u2") return values_of<std::uint16_t>(file, bytes, header);
  refuse(file, "has values of type \"", header.type.substr(0, 16), "\": expected float32, float64 or uint16");
}

}  // namespace

void mark_missing_points(PointCloud& cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = cloud.point(i);
    if (p.allFinite() && !p.isZero(0)) continue;
    cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<ImageLayout> fit_pinhole(const PointCloud& cloud, int width, int height) {
  // A pinhole camera sees no point behind it. The fit cannot detect such a point, because x/z is the same at
  // (-x, -z).
  const auto behind_camera = [](double z_m) { return z_m <= 0; };
  if (std::any_of(cloud.z.begin(), cloud.z.end(), behind_camera)) return std::nullopt;
  const std::size_t columns = static_cast<std::size_t>(width);
  const auto u = fit_axis(ratios(cloud.x, cloud.z), columns, true);
  const auto v = fit_axis(ratios(cloud.y, cloud.z), columns, false);
  if (!u || !v || !(u->focal > 0) || !(v->focal > 0)) return std::nullopt;
  const double residual = std::max(u->residual, v->residual);
  if (!(residual < kMaxFitResidual_px)) return std::nullopt;
  const CameraIntrinsics camera{width, height, u->focal, v->focal, u->centre, v->centre};
  return ImageLayout{camera, RigidTransform::Identity(), residual + kPixelRounding_px};
}

GreyImage decode_grey_png(std::string_view bytes, const std::string& name) {
  PngFile png(bytes, name);
  return grey_image(png, name);
}

DepthImage read_depth_png(const std::filesystem::path& file, double metres_per_unit, double max_depth_m) {
  PngFile png(file);
  const GreyImage image = grey_image(png, file.string());
  DepthImage depth{image.width, image.height, std::vector<double>(image.values.size())};
  for (std::size_t i = 0; i < depth.z_m.size(); ++i) {
    const int value = image.values[i];
    const double z_m = value * metres_per_unit;
    depth.z_m[i] = value == 0 || z_m > max_depth_m ? std::numeric_limits<double>::quiet_NaN() : z_m;
  }
  return depth;
}

std::vector<std::uint32_t> read_colour_png(const std::filesystem::path& file, int& width, int& height) {
  PngFile png(file);
  if (png.bit_depth() > 8)
    refuse(file.string(), "pixels are ", png.pixel_format(), ": expected up to 8 bits a channel");
  width = png.width(), height = png.height();
  const std::vector<png_byte>& bytes = png.decode_as_rgba();
  std::vector<std::uint32_t> colour(bytes.size() / 4);
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const png_byte* const rgba = &bytes[4 * i];
    colour[i] = rgba[3] == 0 ? kNoColour : static_cast<std::uint32_t>(rgba[0] << 16 | rgba[1] << 8 | rgba[2]);
  }
  return colour;
}

DepthImage read_depth_npy(const std::filesystem::path& file, double metres_per_unit, double max_depth_m) {
  const std::string bytes = bytes_in(file);
  const NpyHeader header = header_of(file, bytes);
  const std::vector<double> values = numbers_in(file, bytes, header);
  const double missing = header.type.ends_with("u2") ? 65535 : 0;
  DepthImage depth{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  depth.z_m.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t u = header.is_fortran ? i / header.height : i % header.width;
    const std::size_t v = header.is_fortran ? i % header.height : i / header.width;
    if (values[i] < 0 && std::isfinite(values[i]))
      refuse(file, "pixel ", u, ", ", v, " has the depth ", values[i],
             ": expected above 0, or 0 or NaN for none");
    const double z_m = values[i] * metres_per_unit;
    const bool is_measured = values[i] != missing && z_m > 0 && std::isfinite(z_m) && z_m <= max_depth_m;
    depth.z_m[v * header.width + u] = is_measured ? z_m : std::numeric_limits<double>::quiet_NaN();
  }
  return depth;
}

void distances_to_depths(const CameraIntrinsics& camera, DepthImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.z_m.size(); ++i) {
    const std::size_t column = i % width, row = i / width;
    image.z_m[i] /= unproject(camera, static_cast<double>(column), static_cast<double>(row), 1).norm();
  }
}

}  // namespace remote_touch

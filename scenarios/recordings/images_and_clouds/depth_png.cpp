#include "scenarios/recordings/images_and_clouds/depth_png.h"

#include <png.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>

#include "core/geometry/colour.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

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

}  // namespace

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

}  // namespace remote_touch

#include "scenarios/text/image.hpp"

#include <png.h>

#include <cctype>
#include <cstring>
#include <string_view>
#include <utility>

#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

constexpr long kMaxPixels = 100'000'000;
constexpr std::pair<std::string_view, std::string_view> kOtherImages[] = {
    {"BM", "BMP"}, {"\xFF\xD8\xFF", "JPEG"}, {"GIF8", "GIF"}, {{"II*\0", 4}, "TIFF"}, {{"MM\0*", 4}, "TIFF"}};

class ImageFile {
 public:
  ImageFile(const std::string& file, const NamedBy& named_by)
      : file_(file), named_by_(named_by), bytes_(read_text_file(file, named_by)) {}

  Image read() {
    if (bytes_.rfind("P5", 0) == 0 || bytes_.rfind("P2", 0) == 0) return read_pgm();
    if (bytes_.rfind("\x89PNG", 0) == 0) return read_png();
    for (const auto& [magic, format] : kOtherImages)
      if (bytes_.starts_with(magic))
        throw named_by_.error(file_, "a " + std::string(format) + " image", "an image in PGM (P2, P5) or PNG",
                              "ImageMagick converts it: convert " + file_ + " map.png");
    fail(bytes_.empty() ? "an empty file" : "a file of another format", "an image in PGM (P2, P5) or PNG");
  }

 private:
  [[noreturn]] void fail(std::string found, std::string accepted) const {
    throw named_by_.error(file_, std::move(found), std::move(accepted));
  }

  void check_size(long width, long height) const {
    if (width < 1 || height < 1 || width > kMaxPixels / height)
      fail(std::to_string(width) + " x " + std::to_string(height) + " pixels", "1 to 100,000,000 pixels");
  }

  /// Next whole number of a PGM header or of P2 data; comments run from # to the end of the line.
  long next_number() {
    while (position_ < bytes_.size()) {
      const char c = bytes_[position_];
      if (c == '#')
        while (position_ < bytes_.size() && bytes_[position_] != '\n') ++position_;
      else if (std::isspace(static_cast<unsigned char>(c)))
        ++position_;
      else
        break;
    }
    long value = 0;
    const std::size_t first = position_;
    for (; position_ < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[position_]));
         ++position_)
      if ((value = 10 * value + (bytes_[position_] - '0')) > 1'000'000'000)
        fail("a number that is too large", "a PGM image");
    if (position_ == first)
      fail(position_ < bytes_.size() ? "a character that is not a digit in a number"
                                     : "an image that ends too early",
           "a whole PGM image");
    return value;
  }

  Image read_pgm() {
    const bool binary = bytes_[1] == '5';
    position_ = 2;
    const long width = next_number(), height = next_number(), white = next_number();
    check_size(width, height);
    if (white < 1 || white > 65535) fail("greatest gray value " + std::to_string(white), "1 to 65535");
    Image image{.width = static_cast<int>(width), .height = static_cast<int>(height)};
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const std::size_t size = white > 255 ? 2 : 1;
    ++position_;
    if (binary && bytes_.size() < position_ + pixels * size)
      fail("an image that ends too early (" +
               std::to_string(bytes_.size() - std::min(bytes_.size(), position_)) + " of " +
               std::to_string(pixels * size) + " bytes)",
           "a whole PGM image");
    if (!binary && bytes_.size() < position_ + 2 * pixels - 1)
      fail("an image that ends too early", "a whole PGM image");
    image.shade.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      const long value = binary ? binary_value(i, size) : next_number();
      if (value > white)
        fail("gray value " + std::to_string(value),
             "at most " + std::to_string(white) + ", as the header says");
      image.shade[i] = static_cast<double>(value) / static_cast<double>(white);
    }
    return image;
  }

  [[nodiscard]] long binary_value(std::size_t index, std::size_t size) const {
    const auto byte = [&](std::size_t at) {
      return static_cast<long>(static_cast<unsigned char>(bytes_[at]));
    };
    if (size == 1) return byte(position_ + index);
    return 256 * byte(position_ + 2 * index) + byte(position_ + 2 * index + 1);
  }

  Image read_png() const {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&png, bytes_.data(), bytes_.size())) fail_png(png);
    png.format = PNG_FORMAT_RGBA;
    const long width = png.width, height = png.height;
    if (width < 1 || height < 1 || width > kMaxPixels / height) png_image_free(&png);
    check_size(width, height);
    std::vector<unsigned char> rgba(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr)) fail_png(png);
    Image image{.width = static_cast<int>(width), .height = static_cast<int>(height)};
    const std::size_t pixels = rgba.size() / 4;
    image.shade.resize(pixels);
    image.transparent.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      image.shade[i] = (rgba[4 * i] + rgba[4 * i + 1] + rgba[4 * i + 2]) / (3.0 * 255.0);
      image.transparent[i] = rgba[4 * i + 3] != 255;
    }
    return image;
  }

  [[noreturn]] void fail_png(png_image& png) const {
    const std::string reason = png.message;
    png_image_free(&png);
    fail("a broken PNG (" + reason + ")", "a whole PNG image");
  }

  std::string file_;
  NamedBy named_by_;
  std::string bytes_;
  std::size_t position_{};
};

}  // namespace

Image read_image(const std::string& file, const NamedBy& named_by) {
  return ImageFile(file, named_by).read();
}

}  // namespace joulepath

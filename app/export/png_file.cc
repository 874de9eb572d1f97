#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/export/export.h"
#include "core/errors.h"
#include "core/files.h"

namespace annulus::app {

void write_png(const std::filesystem::path& svg, const std::filesystem::path& png) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, decltype(&g_object_unref)> handle(rsvg_handle_new_from_file(svg.c_str(), &error),
                                                                      [](gpointer p) {
                                                                        if (p != nullptr) g_object_unref(p);
                                                                      });
  if (!handle) {
    const std::string why = error != nullptr ? error->message : "unknown";
    g_clear_error(&error);
    throw InputError(fmt::format("{}: is not a picture: {}", svg.string(), why));
  }
  gboolean has_box = FALSE;
  RsvgRectangle box{};
  rsvg_handle_get_intrinsic_dimensions(handle.get(), nullptr, nullptr, nullptr, nullptr, &has_box, &box);
  if (has_box == FALSE || !(box.width > 0 && box.width < 10000 && box.height > 0 && box.height < 10000))
    throw InputError(fmt::format("{}: has no size", svg.string()));
  // Per unit of a plot: some 300 per inch at the width of a page. The units of a body are its millimetres.
  constexpr double usual_pixels = 4, least_size = 1600;
  const double pixels = std::max(usual_pixels, least_size / std::max(box.width, box.height));
  const RsvgRectangle whole{0, 0, pixels * box.width, pixels * box.height};
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(std::ceil(whole.width)),
                                 static_cast<int>(std::ceil(whole.height))),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  if (rsvg_handle_render_document(handle.get(), context.get(), &whole, nullptr) == FALSE)
    throw InputError(fmt::format("{}: cannot be drawn", svg.string()));
  UnfinishedFile unfinished(png, ".png");
  if (cairo_surface_write_to_png(surface.get(), unfinished.temporary().c_str()) != CAIRO_STATUS_SUCCESS)
    throw cannot_write(png, 0);
  unfinished.finish();
}

}  // namespace annulus::app

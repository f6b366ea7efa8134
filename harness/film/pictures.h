// The pictures of a recording: every take at some frames, by the same camera.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "harness/film/recording.h"
#include "harness/film/tracer.h"

namespace harness {

struct PictureSpec {
  std::vector<std::size_t> frames;  // in rising order
  int width = 480;                  // pixels
  int samples = 2;                  // a pixel has samples x samples
};

// What a take shows at a frame.
Shot shot_of(const Recording& recording, const View& view, std::size_t take, std::size_t frame,
             int width);

// Into a folder that is there: <take>-<frame>.ppm for each frame that the take has, and its last
// one if it ended early; pictures.json with the width, the height, the frames, and the colours of
// strain over its limit from 0 to legend_end. On all cores that the process may use. told: how many
// of all are done. Throws FileError, Interrupted.
void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<bool()>& interrupted,
                    const std::function<void(std::size_t done, std::size_t all)>& told);

}  // namespace harness

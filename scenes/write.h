// Puts what was edited back into a scene file: comments, order and all that is not edited stay as they are.
#pragma once

#include <filesystem>
#include <string>

#include "scenes/scene.h"

namespace arealab {

// `text` is what `before` was read from; `after` differs from it in lights, materials, camera or exposure. Returns the
// text that reads as `after`; numbers are kept to nine digits, and a light that was turned states its `normal` (and `up`
// where that alone would not do). Lights may be added and taken away, materials not. Throws InputError where `after`
// is no scene that a file may hold.
std::string EditedText(const std::string& text, const Scene& before, const Scene& after);

// The same for the file that `after.file` names, which is replaced in one step. Throws InputError where what it then
// holds does not read as `after`, since someone else has edited it, or where it cannot be written.
void SaveScene(const Scene& before, const Scene& after);

}  // namespace arealab

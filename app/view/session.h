// What the window works on: the scene and its edits with their undo, and how it is looked at. No OpenGL, no windowing.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "app/view/display.h"
#include "app/view/worker.h"
#include "glsl/effects.h"
#include "scenes/scene.h"

namespace arealab {

enum class Layout { kSingle, kWipe, kDifference, kFlicker, kGrid };
enum class Navigation { kBlender, kMaya };
enum class GizmoMode { kMove, kTurn, kScale };

// What an edit changes and an undo brings back.
struct Edits {
  std::vector<Light> lights;
  std::vector<Material> materials;
  double exposure = 0.0;
  std::optional<Sky> sky;
};
bool Same(const Light& a, const Light& b);
bool Same(const Material& a, const Material& b);
bool Same(const Edits& a, const Edits& b);
bool Same(const Camera& a, const Camera& b);

// A scene, what it was read from, when that began, and, where no file holds it yet, the text that a save begins with.
struct Opened {
  Scene scene;
  std::string text;
  std::set<std::filesystem::path> files{};
  std::filesystem::file_time_type begun = std::filesystem::file_time_type::clock::now();
};

// A picture that was kept, to be compared with what comes after it. Panes name one "#1", "#2", …
struct Snapshot {
  std::string name, label;
  ShadedVariant picture, thumbnail;
};
constexpr std::size_t kMostSnapshots = 9;

class Session {
 public:
  explicit Session(Opened opened);

  Scene scene;                 // as it is edited
  std::uint64_t geometry = 0;  // another number: other meshes
  std::set<std::filesystem::path> files;  // that the scene was read from, or would have been; what edits add is in Files alone

  // How it is looked at.
  std::array<ShownVariant, 4> panes;  // A, B and, in a grid, C and D
  int grid_panes = 4;
  Layout layout = Layout::kWipe;
  DisplaySettings display;
  float wipe = 0.5f;      // 0 … 1 of the width
  double exposure = 0.0;  // EV on top of the scene's
  Lobe lobe = Lobe::kTotal;
  bool false_color = false;
  std::string ocio_view;  // of the user's configuration, where that is the transform
  Navigation navigation = Navigation::kBlender;
  std::vector<Camera> cameras;  // saved
  GizmoMode gizmo = GizmoMode::kMove;
  std::set<std::string> effects_off;
  bool measure = false;
  std::string gpu = "bonaire";  // whose cycles are counted while measuring
  int light = -1;     // selected, or -1
  int material = 0;   // selected
  std::optional<glm::dvec2> inspected;  // 0 … 1 across the picture, from its top left
  bool show_lobe = true;                // of the inspected pixel, on the picture
  std::string case_light;               // whose case is copied there; empty or gone: the one that fills most of the hemisphere

  std::vector<Snapshot> snapshots;

  // Of the scene as it is.
  const std::vector<Effect>& Effects();

  // The snapshot that a pane names, or null where it names a variant.
  const Snapshot* SnapshotOf(const ShownVariant& pane) const;
  // Of a picture as it is shown; the oldest goes where there are too many.
  void Keep(const ShadedVariant& picture);
  // Panes that show it show the variant it was of.
  void Drop(const std::string& snapshot);
  int PaneCount() const { return layout == Layout::kGrid ? grid_panes : layout == Layout::kSingle ? 1 : 2; }

  // Ends an edit where one was made since the last call: call it when no control is held.
  void Commit();
  void Undo();
  void Redo();
  bool CanUndo() const { return !undo_.empty(); }
  bool CanRedo() const { return !redo_.empty(); }
  // Whether anything that a scene file holds differs from the file.
  bool Dirty() const;

  // Writes what was edited into the scene file; the camera only where it was made the scene's. Throws InputError.
  void Save();
  void KeepCamera() { file_camera_ = scene.camera; }
  // Writes unsaved edits to the user's state folder where they are newer than what is there; removes it where there are
  // none. A crash then loses no more than what came since the last call.
  void Autosave();
  // What an earlier session left unsaved of this scene; brought back as an edit that can be undone.
  bool HasLeftBehind() const;
  void Restore();

  // What the scene is read from as it is now edited.
  std::set<std::filesystem::path> Files() const;

  // As the scene file names an image that a light, by its name, or the sky (no name) is to show. Throws InputError where it may not.
  std::string ImagePath(const std::string& light, const std::filesystem::path& file) const;
  void ShowImage(const std::string& light, const std::string& path, std::shared_ptr<const Image> image);
  int AddLight();     // a copy of the selected one, or a first one; its index
  void RemoveLight();  // the selected one, where it is not the last
  // Takes the scene as it is now on disk, keeping how it is looked at; edits since are dropped.
  void Replace(Scene from_disk);
  // The scene as a file would hold it now, as text. Throws InputError.
  std::string EditedSceneText() const;
  // Takes images and meshes of what was read of that text once they have changed on disk; edits and their undo stay. False, and nothing
  // done, where the materials, which a mesh file may bring along, are others too.
  bool Refresh(const Scene& edited);

 private:
  Edits Current() const { return {scene.lights, scene.materials, scene.exposure, scene.sky}; }
  void Set(const Edits& edits);

  std::filesystem::path AutosaveFile() const;
  Scene Saved() const;  // the scene as a save would write it

  Scene on_disk_;
  std::string text_;  // of a scene that no file holds yet
  Camera file_camera_;  // what the file is to hold: the one of the view wanders
  Edits committed_;
  std::vector<Edits> undo_, redo_;
  std::optional<Edits> autosaved_;
  int snapshots_kept_ = 0;
  std::vector<Effect> effects_;  // of the scene that these describe
  std::optional<std::tuple<Edits, Camera, std::uint64_t>> effects_of_;
};

// A built-in name, a scene file, or a mesh alone, which gets a floor, a camera that frames it and a softbox. Throws
// InputError.
// cache: the folder of apertures already baked.
Opened OpenScene(const std::string& name_or_path, const std::filesystem::path& cache);

// A scene file, or what stands in `text` for it, with its apertures, where it asks for them. Adds to `files` what it is read from, also where it throws.
Scene LoadWithApertures(const std::filesystem::path& file, const std::filesystem::path& cache, std::set<std::filesystem::path>& files,
                        const std::string& text = {});
// An image for a light or the sky; throws InputError with its name.
std::shared_ptr<const Image> LoadShownImage(const std::filesystem::path& file, bool sky);

// $XDG_CONFIG_HOME/arealab or ~/.config/arealab; made where it is missing; empty where that fails.
std::filesystem::path ConfigFolder();

}  // namespace arealab

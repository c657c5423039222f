// Compiles shaders for one GPU that is not there and prints what the compiler says of them: a process of its own, since
// RADV reads the GPU's family once (RADV_FORCE_FAMILY) and some families end the process. Run by compare/cost.cpp.
//
// Descriptor 0: per shader three counts of 32 bits (colour targets, words of the vertex and of the fragment shader), then
// the SPIR-V words of both. Descriptor 3: the driver in one line, then a line per shader: "instructions cycles vgprs sgprs
// spills branches bytes", numbers. Exit status 0, or 1 with a line on descriptor 2. AREALAB_VULKAN names the library.
#define VK_NO_PROTOTYPES
#include <dlfcn.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using Words = std::vector<std::uint32_t>;

struct Shader {
  std::uint32_t targets = 0;
  Words vertex, fragment;
};

void Check(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(call) + " fails with " + std::to_string(result));
}

// False at the end of the input.
bool Read(std::FILE* in, Words& words, std::size_t count) {
  words.resize(count);
  return std::fread(words.data(), sizeof(std::uint32_t), count, in) == count;
}

bool Read(std::FILE* in, Shader& shader) {
  Words counts;
  if (!Read(in, counts, 3)) return false;
  shader.targets = counts[0];
  if (!Read(in, shader.vertex, counts[1]) || !Read(in, shader.fragment, counts[2])) {
    throw std::runtime_error("the input ends within a shader");
  }
  return true;
}

class NullDevice {
 public:
  NullDevice() {
    const char* name = std::getenv("AREALAB_VULKAN");
    void* library = dlopen(name != nullptr && *name != '\0' ? name : "libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(std::string("libvulkan does not load (") + dlerror() + ")");
    get_ = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
    if (get_ == nullptr) throw std::runtime_error("libvulkan has no vkGetInstanceProcAddr");

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_2;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    Check(Get<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &instance_), "vkCreateInstance");
    std::uint32_t count = 1;
    Get<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices")(instance_, &count, &physical_);
    if (count == 0) throw std::runtime_error("the driver shows no device of that name");
  }

  // "radv Mesa 22.3.6-1+deb12u1"
  std::string Driver() const {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    Get<PFN_vkGetPhysicalDeviceProperties2>("vkGetPhysicalDeviceProperties2")(physical_, &properties);
    return std::string(driver.driverName) + " " + driver.driverInfo;
  }

  void Open() {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature{};
    feature.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    feature.pipelineExecutableInfo = VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &feature;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    Check(Get<PFN_vkCreateDevice>("vkCreateDevice")(physical_, &info, nullptr, &device_), "vkCreateDevice");
    MakeLayout();
  }

  // Name → value of the fragment shader's statistics.
  std::map<std::string, std::uint64_t> Compile(const Shader& shader) const {
    const VkPipeline pipeline = MakePipeline(shader);
    VkPipelineInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    info.pipeline = pipeline;
    const auto list = Get<PFN_vkGetPipelineExecutablePropertiesKHR>("vkGetPipelineExecutablePropertiesKHR");
    std::uint32_t count = 0;
    list(device_, &info, &count, nullptr);
    VkPipelineExecutablePropertiesKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::vector<VkPipelineExecutablePropertiesKHR> executables(count, empty);
    list(device_, &info, &count, executables.data());
    std::map<std::string, std::uint64_t> found;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (executables[i].stages & VK_SHADER_STAGE_FRAGMENT_BIT) AddStatistics(pipeline, i, found);
    }
    Get<PFN_vkDestroyPipeline>("vkDestroyPipeline")(device_, pipeline, nullptr);
    return found;
  }

 private:
  template <typename Function>
  Function Get(const char* name) const {
    return reinterpret_cast<Function>(get_(instance_, name));
  }

  // Where compare/spirv.cpp puts things: samplers from 0, uniform blocks from 16, others after them.
  void MakeLayout() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::uint32_t i = 0; i < 32; ++i) {
      const auto type = i < 16 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
      bindings.push_back({i, type, 1, VK_SHADER_STAGE_ALL_GRAPHICS, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    VkDescriptorSetLayout set_layout{};
    Check(Get<PFN_vkCreateDescriptorSetLayout>("vkCreateDescriptorSetLayout")(device_, &set, nullptr, &set_layout),
          "vkCreateDescriptorSetLayout");
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    Check(Get<PFN_vkCreatePipelineLayout>("vkCreatePipelineLayout")(device_, &info, nullptr, &layout_),
          "vkCreatePipelineLayout");
  }

  VkRenderPass MakeRenderPass(std::uint32_t targets) const {
    VkAttachmentDescription target{};
    target.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    target.samples = VK_SAMPLE_COUNT_1_BIT;
    target.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    const std::vector<VkAttachmentDescription> descriptions(targets, target);
    std::vector<VkAttachmentReference> references;
    for (std::uint32_t i = 0; i < targets; ++i) references.push_back({i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    VkSubpassDescription subpass{};
    subpass.colorAttachmentCount = targets;
    subpass.pColorAttachments = references.data();
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = targets;
    info.pAttachments = descriptions.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPass pass{};
    Check(Get<PFN_vkCreateRenderPass>("vkCreateRenderPass")(device_, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
  }

  VkPipelineShaderStageCreateInfo MakeStage(const Words& words, VkShaderStageFlagBits kind) const {
    VkShaderModuleCreateInfo module{};
    module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module.codeSize = words.size() * sizeof(std::uint32_t);
    module.pCode = words.data();
    VkPipelineShaderStageCreateInfo stage{};
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stage.stage = kind;
    stage.pName = "main";
    Check(Get<PFN_vkCreateShaderModule>("vkCreateShaderModule")(device_, &module, nullptr, &stage.module),
          "vkCreateShaderModule");
    return stage;
  }

  VkPipeline MakePipeline(const Shader& shader) const {
    const std::array stages{MakeStage(shader.vertex, VK_SHADER_STAGE_VERTEX_BIT),
                            MakeStage(shader.fragment, VK_SHADER_STAGE_FRAGMENT_BIT)};
    const VkVertexInputBindingDescription buffer{0, 32, VK_VERTEX_INPUT_RATE_VERTEX};
    const std::array<VkVertexInputAttributeDescription, 2> attributes{
        {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 16}}};
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &buffer;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
    input.pVertexAttributeDescriptions = attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0.0f, 0.0f, 64.0f, 64.0f, 0.0f, 1.0f};
    const VkRect2D scissor{{0, 0}, {64, 64}};
    VkPipelineViewportStateCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    view.viewportCount = view.scissorCount = 1;
    view.pViewports = &viewport;
    view.pScissors = &scissor;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState write{};
    write.colorWriteMask = 15;
    const std::vector<VkPipelineColorBlendAttachmentState> writes(shader.targets, write);
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = shader.targets;
    blend.pAttachments = writes.data();
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.layout = layout_;
    info.renderPass = MakeRenderPass(shader.targets);
    VkPipeline pipeline{};
    Check(Get<PFN_vkCreateGraphicsPipelines>("vkCreateGraphicsPipelines")(device_, VK_NULL_HANDLE, 1, &info, nullptr,
                                                                          &pipeline),
          "vkCreateGraphicsPipelines");
    return pipeline;
  }

  void AddStatistics(VkPipeline pipeline, std::uint32_t index, std::map<std::string, std::uint64_t>& found) const {
    VkPipelineExecutableInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
    info.pipeline = pipeline;
    info.executableIndex = index;
    const auto list = Get<PFN_vkGetPipelineExecutableStatisticsKHR>("vkGetPipelineExecutableStatisticsKHR");
    std::uint32_t count = 0;
    list(device_, &info, &count, nullptr);
    VkPipelineExecutableStatisticKHR empty{};
    empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> statistics(count, empty);
    list(device_, &info, &count, statistics.data());
    for (const auto& statistic : statistics) found[statistic.name] = statistic.value.u64;
  }

  PFN_vkGetInstanceProcAddr get_ = nullptr;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

void Run() {
  std::FILE* out = fdopen(3, "w");
  if (out == nullptr) throw std::runtime_error("descriptor 3 is closed");
  NullDevice device;
  std::fprintf(out, "%s\n", device.Driver().c_str());
  std::fflush(out);
  Shader shader;
  for (bool open = false; Read(stdin, shader);) {
    if (!std::exchange(open, true)) device.Open();
    const auto found = device.Compile(shader);
    const auto value = [&](const char* name) {
      const auto at = found.find(name);
      if (at == found.end()) throw std::runtime_error(std::string("the driver has no statistic \"") + name + "\"");
      return static_cast<unsigned long long>(at->second);
    };
    std::fprintf(out, "%llu %llu %llu %llu %llu %llu %llu\n", value("Instructions"), value("Inverse Throughput"),
                 value("VGPRs"), value("SGPRs"), value("Spilled SGPRs") + value("Spilled VGPRs"), value("Branches"),
                 value("Code size"));
    std::fflush(out);  // what is done survives the next shader's crash
  }
}

}  // namespace

int main() {
  int status = 0;
  try {
    Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = 1;
  }
  std::fflush(nullptr);
  _exit(status);  // the null device's own clean-up crashes
}

// The minimal renderer of stranger.h with Vulkan, for the exported HLSL compiled to SPIR-V: on a device that a CPU plays (Mesa's lavapipe).
#pragma once

#define VK_NO_PROTOTYPES
#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstring>
#include <regex>

#include "tests/compare/stranger.h"

namespace stranger {

// Bindings of a class of registers begin here: glslangValidator --stb 0 --ssb 32 --scb 64.
constexpr std::uint32_t kSamplerShift = 32, kBufferShift = 64;

// What it makes lives as long as the process.
class Vulkan {
 public:
  Vulkan() {
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return;
    get_ = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    Check(Get<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &instance_));
    std::uint32_t count = 0;
    const auto list = Get<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices");
    list(instance_, &count, nullptr);
    std::vector<VkPhysicalDevice> all(count);
    list(instance_, &count, all.data());
    for (const VkPhysicalDevice device : all) {
      VkPhysicalDeviceProperties properties{};
      Get<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(device, &properties);
      if (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && properties.apiVersion >= VK_API_VERSION_1_3) physical_ = device;
    }
    if (physical_ != VK_NULL_HANDLE) Open();
  }

  bool found() const { return physical_ != VK_NULL_HANDLE; }

  // `hlsl`: what `fragment` was compiled from, for its registers.
  Output Draw(const std::string& folder, const std::string& hlsl, const std::vector<std::uint32_t>& vertex, const std::vector<std::uint32_t>& fragment, const Input& input) {
    const nlohmann::json inputs = nlohmann::json::parse(ReadText(folder + "/inputs.json"));
    size_ = {static_cast<std::uint32_t>(input.width), static_cast<std::uint32_t>(input.height)};
    const auto registers = [&](const char* pattern, const auto& bind) {
      const std::regex form(pattern);
      for (std::sregex_iterator at(hlsl.begin(), hlsl.end(), form), end; at != end; ++at) bind((*at)[1].str(), static_cast<std::uint32_t>(std::stoul((*at)[2])));
    };
    registers("Texture2D<float4> (\\w+) : register\\(t(\\d+)\\)", [&](const std::string& name, std::uint32_t at) {
      if (input.gbuffer.contains(name)) return Bind(at, MakeImage(size_, input.gbuffer.at(name).data(), VK_IMAGE_USAGE_SAMPLED_BIT));
      const std::string header = ReadText(folder + "/" + name + ".h");
      const VkExtent2D size{static_cast<std::uint32_t>(ReadSize(header, name + "_width")), static_cast<std::uint32_t>(ReadSize(header, name + "_height"))};
      Bind(at, MakeImage(size, ReadCArray(header, name).data(), VK_IMAGE_USAGE_SAMPLED_BIT));
    });
    registers("SamplerState (\\w+) : register\\(s(\\d+)\\)", [&](const std::string&, std::uint32_t at) { BindSampler(kSamplerShift + at); });
    registers("cbuffer (\\w+) : register\\(b(\\d+)\\)", [&](const std::string& name, std::uint32_t at) {
      std::vector<float> values = input.light_rows;
      values.resize(inputs["light_block"]["lights"].get<std::size_t>() * inputs["light_block"]["rows_per_light"].get<std::size_t>() * 4);
      if (name != "LightBlock") values.assign(input.view_position.begin(), input.view_position.end());  // the only loose uniform, at c0
      values.resize((values.size() + 3) / 4 * 4);
      BindBuffer(kBufferShift + at, values);
    });
    const std::array<Image, 2> targets{MakeImage(size_, nullptr, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT), MakeImage(size_, nullptr, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)};
    Submit(vertex, fragment, targets);
    return {ReadBack(targets[0]), ReadBack(targets[1])};
  }

 private:
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    char* texels = nullptr;
    VkSubresourceLayout layout{};
  };
  struct Bound {
    VkDescriptorSetLayoutBinding slot{};
    VkDescriptorImageInfo image{};
    VkDescriptorBufferInfo buffer{};
  };

  static void Check(VkResult result) {
    if (result != VK_SUCCESS) throw std::runtime_error("Vulkan says " + std::to_string(result));
  }
  template <typename Function>
  Function Get(const char* name) const { return reinterpret_cast<Function>(get_(instance_, name)); }
  // vkCreateNAME(device, info, nullptr, object).
  template <typename Info, typename Object>
  Object Make(const char* name, const Info& info) const {
    Object object{};
    Check(Get<VkResult (*)(VkDevice, const Info*, const VkAllocationCallbacks*, Object*)>(name)(device_, &info, nullptr, &object));
    return object;
  }

  void Open() {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features.dynamicRendering = VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    Check(Get<PFN_vkCreateDevice>("vkCreateDevice")(physical_, &info, nullptr, &device_));
  }

  // All of lavapipe's memory is the host's.
  VkDeviceMemory Allocate(VkDeviceSize size) const {
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = size;
    return Make<VkMemoryAllocateInfo, VkDeviceMemory>("vkAllocateMemory", info);
  }
  char* Map(VkDeviceMemory memory) const {
    void* data = nullptr;
    Check(Get<PFN_vkMapMemory>("vkMapMemory")(device_, memory, 0, VK_WHOLE_SIZE, 0, &data));
    return static_cast<char*>(data);
  }

  Image MakeImage(VkExtent2D size, const float* texels, VkImageUsageFlags usage) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    info.extent = {size.width, size.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_LINEAR;
    info.usage = usage;
    info.initialLayout = VK_IMAGE_LAYOUT_PREINITIALIZED;
    Image image;
    image.image = Make<VkImageCreateInfo, VkImage>("vkCreateImage", info);
    VkMemoryRequirements needs{};
    Get<PFN_vkGetImageMemoryRequirements>("vkGetImageMemoryRequirements")(device_, image.image, &needs);
    const VkDeviceMemory memory = Allocate(needs.size);
    Check(Get<PFN_vkBindImageMemory>("vkBindImageMemory")(device_, image.image, memory, 0));
    const VkImageSubresource all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
    Get<PFN_vkGetImageSubresourceLayout>("vkGetImageSubresourceLayout")(device_, image.image, &all, &image.layout);
    image.texels = Map(memory) + image.layout.offset;
    for (std::uint32_t y = 0; texels != nullptr && y < size.height; ++y) {
      std::memcpy(image.texels + y * image.layout.rowPitch, texels + 4 * y * size.width, 16 * size.width);
    }
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = info.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    image.view = Make<VkImageViewCreateInfo, VkImageView>("vkCreateImageView", view);
    images_.push_back(image);
    return image;
  }

  std::vector<float> ReadBack(const Image& image) const {
    std::vector<float> texels(4 * size_.width * size_.height);
    for (std::uint32_t y = 0; y < size_.height; ++y) {
      std::memcpy(&texels[4 * y * size_.width], image.texels + y * image.layout.rowPitch, 16 * size_.width);
    }
    return texels;
  }

  Bound& Slot(std::uint32_t binding, VkDescriptorType type) {
    Bound& bound = bound_.emplace_back();
    bound.slot = {binding, type, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    return bound;
  }
  void Bind(std::uint32_t binding, const Image& image) {
    Slot(binding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE).image = {VK_NULL_HANDLE, image.view, VK_IMAGE_LAYOUT_GENERAL};
  }
  void BindSampler(std::uint32_t binding) {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    Slot(binding, VK_DESCRIPTOR_TYPE_SAMPLER).image.sampler = Make<VkSamplerCreateInfo, VkSampler>("vkCreateSampler", info);
  }
  void BindBuffer(std::uint32_t binding, const std::vector<float>& values) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = 4 * values.size();
    info.usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    const VkBuffer buffer = Make<VkBufferCreateInfo, VkBuffer>("vkCreateBuffer", info);
    VkMemoryRequirements needs{};
    Get<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(device_, buffer, &needs);
    const VkDeviceMemory memory = Allocate(needs.size);
    Check(Get<PFN_vkBindBufferMemory>("vkBindBufferMemory")(device_, buffer, memory, 0));
    std::memcpy(Map(memory), values.data(), info.size);
    Slot(binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER).buffer = {buffer, 0, VK_WHOLE_SIZE};
  }

  VkPipeline MakePipeline(const std::vector<std::uint32_t>& vertex, const std::vector<std::uint32_t>& fragment, VkPipelineLayout layout) const {
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<std::uint32_t>& words = i == 0 ? vertex : fragment;
      VkShaderModuleCreateInfo module{};
      module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
      module.codeSize = 4 * words.size();
      module.pCode = words.data();
      stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
      stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
      stages[i].module = Make<VkShaderModuleCreateInfo, VkShaderModule>("vkCreateShaderModule", module);
      stages[i].pName = "main";
    }
    const std::array<VkFormat, 2> formats{VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 2;
    rendering.pColorAttachmentFormats = formats.data();
    VkPipelineVertexInputStateCreateInfo no_input{};
    no_input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    const VkViewport viewport{0.0f, 0.0f, static_cast<float>(size_.width), static_cast<float>(size_.height), 0.0f, 1.0f};
    const VkRect2D scissor{{0, 0}, size_};
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
    std::array<VkPipelineColorBlendAttachmentState, 2> written{};
    for (auto& target : written) target.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 2;
    blend.pAttachments = written.data();
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &no_input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    Check(Get<PFN_vkCreateGraphicsPipelines>("vkCreateGraphicsPipelines")(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
    return pipeline;
  }

  void Submit(const std::vector<std::uint32_t>& vertex, const std::vector<std::uint32_t>& fragment, const std::array<Image, 2>& targets) {
    std::vector<VkDescriptorSetLayoutBinding> slots;
    for (const Bound& bound : bound_) slots.push_back(bound.slot);
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<std::uint32_t>(slots.size());
    set_info.pBindings = slots.data();
    const auto set_layout = Make<VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout>("vkCreateDescriptorSetLayout", set_info);
    VkPipelineLayoutCreateInfo layout_info{};
    layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout;
    const auto layout = Make<VkPipelineLayoutCreateInfo, VkPipelineLayout>("vkCreatePipelineLayout", layout_info);
    const VkPipeline pipeline = MakePipeline(vertex, fragment, layout);

    const std::array<VkDescriptorPoolSize, 3> sizes{{{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 16}, {VK_DESCRIPTOR_TYPE_SAMPLER, 16}, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 16}}};
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorSetAllocateInfo set_allocation{};
    set_allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set_allocation.descriptorPool = Make<VkDescriptorPoolCreateInfo, VkDescriptorPool>("vkCreateDescriptorPool", pool_info);
    set_allocation.descriptorSetCount = 1;
    set_allocation.pSetLayouts = &set_layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    Check(Get<PFN_vkAllocateDescriptorSets>("vkAllocateDescriptorSets")(device_, &set_allocation, &set));
    for (const Bound& bound : bound_) {
      VkWriteDescriptorSet write{};
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      write.dstSet = set;
      write.dstBinding = bound.slot.binding;
      write.descriptorCount = 1;
      write.descriptorType = bound.slot.descriptorType;
      write.pImageInfo = &bound.image;
      write.pBufferInfo = &bound.buffer;
      Get<PFN_vkUpdateDescriptorSets>("vkUpdateDescriptorSets")(device_, 1, &write, 0, nullptr);
    }

    VkCommandPoolCreateInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = Make<VkCommandPoolCreateInfo, VkCommandPool>("vkCreateCommandPool", commands);
    allocation.commandBufferCount = 1;
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    Check(Get<PFN_vkAllocateCommandBuffers>("vkAllocateCommandBuffers")(device_, &allocation, &buffer));
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    Check(Get<PFN_vkBeginCommandBuffer>("vkBeginCommandBuffer")(buffer, &begin));
    for (const Image& image : images_) {
      VkImageMemoryBarrier barrier{};
      barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
      barrier.srcAccessMask = VK_ACCESS_HOST_WRITE_BIT;
      barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
      barrier.oldLayout = VK_IMAGE_LAYOUT_PREINITIALIZED;
      barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
      barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
      barrier.image = image.image;
      barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      Get<PFN_vkCmdPipelineBarrier>("vkCmdPipelineBarrier")(buffer, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    }
    std::array<VkRenderingAttachmentInfo, 2> attachments{};
    for (std::size_t i = 0; i < 2; ++i) {
      attachments[i].sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
      attachments[i].imageView = targets[i].view;
      attachments[i].imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      attachments[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    }
    VkRenderingInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    rendering.renderArea = {{0, 0}, size_};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 2;
    rendering.pColorAttachments = attachments.data();
    Get<PFN_vkCmdBeginRendering>("vkCmdBeginRendering")(buffer, &rendering);
    Get<PFN_vkCmdBindPipeline>("vkCmdBindPipeline")(buffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    Get<PFN_vkCmdBindDescriptorSets>("vkCmdBindDescriptorSets")(buffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
    Get<PFN_vkCmdDraw>("vkCmdDraw")(buffer, 3, 1, 0, 0);
    Get<PFN_vkCmdEndRendering>("vkCmdEndRendering")(buffer);
    Check(Get<PFN_vkEndCommandBuffer>("vkEndCommandBuffer")(buffer));
    VkQueue queue = VK_NULL_HANDLE;
    Get<PFN_vkGetDeviceQueue>("vkGetDeviceQueue")(device_, 0, 0, &queue);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &buffer;
    Check(Get<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, 1, &submit, VK_NULL_HANDLE));
    Check(Get<PFN_vkQueueWaitIdle>("vkQueueWaitIdle")(queue));
  }

  PFN_vkGetInstanceProcAddr get_ = nullptr;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkExtent2D size_{};
  std::vector<Image> images_;
  std::vector<Bound> bound_;
};

}  // namespace stranger

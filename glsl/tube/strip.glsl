// A tube as the flat strip between its lines of contact, shaded as a rectangle [ours]: StripOfTube of tube_view.glsl.

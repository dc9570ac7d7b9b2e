"""Where everything is and what it is made of: materials, parts, linkages, poses, meshes."""

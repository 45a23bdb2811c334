"""A robot folder from a model that somebody else wrote: MJCF or URDF in, YAML and MJCF out."""

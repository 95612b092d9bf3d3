"""Planning: where to put an artefact and which poses to take, before anything is measured."""

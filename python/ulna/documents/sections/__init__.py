"""What documents say, section by section, said once: blocks that know no medium. Renderings only set them."""

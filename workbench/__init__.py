"""The workbench server: shows runs in a browser and accepts commands; it contains neither cognition nor physics."""

"""The robot put together: one brain for any body; its parts are usable one by one."""
